#include <fmt/format.h>

#include <utility>

#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_expect.hpp"

// IS-34, IS-35, IS-41 and IS-45 to IS-47: what a slave has to tell, in the message bits of its ID register.
namespace fieldproof::conformance {
namespace {

std::uint16_t read_messages(SlaveBench& bench, CaseJudge& judge) {
  const interbus::Rules& r = bench.rules();
  bench.id_cycle(bench.interfaces_off());
  return id_register(bench, judge) &
         (r.message_check_error | r.message_peripheral_fault | r.message_reconfiguration);
}

void expect_messages(SlaveBench& bench, CaseJudge& judge, std::uint16_t expected, std::string_view reason,
                     std::string_view why) {
  const std::uint16_t found = read_messages(bench, judge);
  judge.expect(found == expected, reason, [&] {
    return Mismatch{.expected = {fmt::format("message bits {:04X}h: {}", expected, why)},
                    .actual = fmt::format("message bits {:04X}h", found),
                    .time = bench.out().start_of(bench.out().data_telegrams()[0]),
                    .first_difference = "bits 13 to 15 of the ID register"};
  });
}

void expect_undisturbed_data_cycles(SlaveBench& bench, CaseJudge& judge) {
  for (unsigned n = 0; n < 3; ++n) {
    const std::vector<std::uint16_t> words = bench.random_words();
    bench.set_inputs(bench.random_words());
    bench.data_cycle(words);
    const std::optional<CycleOnLine> out = bench.cycle_on(bench.out(), 0);
    judge.expect(out && out->status() == bench.rules().status_clean, "data_cycle_disturbed",
                 "a data cycle with a clean status word", "its status word did not leave clean");
    expect_answer(bench, judge, 0, bench.data_load());
    expect_outputs(bench, judge, words, "data_cycle_disturbed");
  }
}

// A condition at the terminals that is to show as one message bit as long as it lasts.
void check_condition(SlaveBench& bench, CaseJudge& judge, std::uint16_t message, std::string_view reason,
                     const std::function<void(bool)>& set) {
  bench.bring_up();
  expect_messages(bench, judge, 0, "message_without_cause", "nothing is to be reported");
  for (unsigned round = 0; round < bench.volume(2U, 20U); ++round) {
    set(true);
    expect_undisturbed_data_cycles(bench, judge);
    expect_messages(bench, judge, message, reason, "reported in the next ID cycle");
    expect_undisturbed_data_cycles(bench, judge);
    set(false);
    expect_undisturbed_data_cycles(bench, judge);
    // What was pending when it ended may still be read once.
    read_messages(bench, judge);
    expect_messages(bench, judge, 0, "message_not_cleared", "it has ended and was read");
  }
}

void peripheral_fault_is_told(SlaveBench& bench, CaseJudge& judge) {
  check_condition(
      bench, judge, bench.rules().message_peripheral_fault, "peripheral_fault_not_told",
      [&](bool on) { bench.terminals().set_peripheral_fault([on](kernel::Time) { return on; }); });
}

void reconfiguration_is_told(SlaveBench& bench, CaseJudge& judge) {
  check_condition(bench, judge, bench.rules().message_reconfiguration, "reconfiguration_not_told",
                  [&](bool on) { bench.terminals().set_reconfiguration([on](kernel::Time) { return on; }); });
}

void send_flipped(SlaveBench& bench) {
  bench.begin();
  const CyclePlace& cycle = bench.append_data_cycle(bench.random_words());
  const auto bit = static_cast<std::size_t>(bench.random().below(bench.code_word_bits()));
  bench.channel().on_next().flip(bench.code_word_level(cycle, bit));
  bench.send();
}

void check_error_is_told_once(SlaveBench& bench, CaseJudge& judge) {
  const std::uint16_t message = bench.rules().message_check_error;
  bench.bring_up();
  for (unsigned round = 0; round < bench.volume(2U, 20U); ++round) {
    expect_good_cycle(bench, judge, "valid_cycle_rejected");
    expect_messages(bench, judge, 0, "message_without_error", "no cycle was rejected");
    for (unsigned n = 0; n < 2; ++n) {
      send_flipped(bench);
      expect_rejected(bench, judge, 0);
    }
    expect_messages(bench, judge, message, "message_missing", "two cycles were rejected");
    expect_messages(bench, judge, 0, "message_not_cleared", "the message has been read");
    send_flipped(bench);
    expect_good_cycle(bench, judge, "valid_cycle_rejected");
    expect_messages(bench, judge, message, "message_cleared_unread",
                    "a cycle was rejected; the good data cycle after it does not read the message");
  }
}

// An ID cycle that a station in front has marked: the master does not take what it brings back.
void message_waits_for_a_good_id_cycle(SlaveBench& bench, CaseJudge& judge) {
  const std::uint16_t message = bench.rules().message_check_error;
  bench.bring_up();
  for (unsigned round = 0; round < bench.volume(3U, 20U); ++round) {
    send_flipped(bench);
    for (unsigned n = 0; n < 2; ++n) {
      bench.begin();
      mark_in_front(bench, bench.append_id_cycle(bench.interfaces_off()));
      bench.send();
    }
    expect_messages(bench, judge, message, "message_cleared_unread",
                    "a cycle was rejected, and both ID cycles after it were marked");
    expect_messages(bench, judge, 0, "message_not_cleared", "the message has been read");
  }
}

void missing_stop_level_is_told(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  bench.begin();
  const std::size_t telegrams = bench.append_data_cycle(bench.random_words()).telegrams();
  for (std::size_t k = 0; k < telegrams; ++k) {
    bench.begin();
    const CyclePlace& cycle = bench.append_data_cycle(bench.random_words());
    bench.channel().on_next().flip(cycle.level_of(k, TrainWriter::kStopLevel));
    bench.send();
    bench.status_telegrams(2);
    expect_messages(bench, judge, bench.rules().message_check_error, "message_missing",
                    fmt::format("telegram {} of the data cycle before had no stop level", k));
    expect_messages(bench, judge, 0, "message_not_cleared", "the message has been read");
  }
}

void add_cases_of_check_errors(std::vector<SlaveCase>& cases) {
  cases.push_back(
      {{.id = "interbus/slave/messages/marked_id_cycle_leaves_the_message",
        .purpose = "IS-45",
        .requirement = "Only a good ID cycle clears the message of a check error: what one with a marked "
                       "status word brings back, the master does not take.",
        .reference = sources::own("messages are cleared by having been read by a good ID cycle"),
        .stimulus = "A data cycle with one bit flipped at the slave's receiver; two ID cycles whose status "
                    "word arrives marked; two ID cycles.",
        .expected = "The message in the first of the last two, none in the second.",
        .tags = {"must"},
        .catches = {{"message_cleared_by_marked_id_cycle", "message_cleared_unread"}},
        .not_applicable = for_every_slave()},
       message_waits_for_a_good_id_cycle});
  cases.push_back(
      {{.id = "interbus/slave/messages/missing_stop_bit_is_told",
        .purpose = "IS-46",
        .requirement = "A missing stop bit in a data telegram is an error of its cycle: the message of "
                       "a check error stands in the next ID cycle.",
        .reference = sources::own("errors besides the check set the check error message"),
        .details = {details::message()},
        .stimulus = "Data cycles in which the stop bit of one telegram arrives as 0, each telegram "
                    "in turn; two status telegrams and two ID cycles after each.",
        .expected = "The message in the first ID cycle, none in the second.",
        .tags = {"must"},
        .catches = {{"tells_no_missing_stop", "message_missing"},
                    {"stop_bit_not_checked", "message_missing"}},
        .not_applicable = for_every_slave()},
       missing_stop_level_is_told});
  cases.push_back({{.id = "interbus/slave/messages/other_message_bits_count",
                    .purpose = "IS-47",
                    .requirement = "The bits of the messages are those that the settings of the case say.",
                    .reference = sources::own("the message bits are settings"),
                    .details = {details::mark(), details::message({"message_missing"})},
                    .stimulus = "As in check_error_is_told_once, with the bits of a check error and of a "
                                "peripheral fault exchanged.",
                    .expected = "As there.",
                    .tags = {"must"},
                    .catches = {{"message_bits_hard_coded", "message_missing"},
                                {"does_not_mark_status", "error_not_marked"}},
                    .not_applicable = for_other_settings()},
                   check_error_is_told_once,
                   {.change_rules = [](interbus::Rules& rules) {
                     std::swap(rules.message_check_error, rules.message_peripheral_fault);
                   }}});
}

}  // namespace

std::vector<SlaveCase> slave_message_cases() {
  std::vector<SlaveCase> cases;
  cases.push_back(
      {{.id = "interbus/slave/messages/peripheral_fault_shows_in_the_next_id_cycle",
        .purpose = "IS-34",
        .requirement =
            "A fault at the periphery is reported by its message bit in the next ID cycle and by nothing "
            "else: data cycles go on undisturbed.",
        .reference = sources::from_memory("messages become visible only in an ID cycle"),
        .details = details::answer(),
        .stimulus =
            "The fault input is set; data cycles, an ID cycle, data cycles; it is cleared; ID cycles.",
        .expected =
            "Data cycles are answered with clean status words; the ID register has the message bit and no "
            "other, and none after the fault has ended and was read.",
        .tags = {"must"},
        .catches = {{"peripheral_fault_not_told", "peripheral_fault_not_told"},
                    {"peripheral_fault_marks_data_cycles", "data_cycle_disturbed"}},
        .not_applicable = for_item("peripheral_fault_input", "the slave has no peripheral fault to report")},
       peripheral_fault_is_told});
  cases.push_back(
      {{.id = "interbus/slave/messages/reconfiguration_button_shows_in_the_next_id_cycle",
        .purpose = "IS-35",
        .requirement =
            "A request for reconfiguration is reported by its own message bit in the next ID cycle.",
        .reference = sources::from_memory("messages become visible only in an ID cycle"),
        .details = details::answer(),
        .stimulus =
            "The button is pressed; data cycles, an ID cycle, data cycles; it is released; ID cycles.",
        .expected = "The ID register has the message bit of reconfiguration and no other while the button is "
                    "pressed, and none after its release was read; data cycles go on undisturbed.",
        .tags = {"must"},
        .catches = {{"messages_confused", "reconfiguration_not_told"}},
        .not_applicable = for_item("reconfiguration_button", "the slave has no reconfiguration button")},
       reconfiguration_is_told});
  cases.push_back(
      {{.id = "interbus/slave/messages/check_error_is_told_once",
        .purpose = "IS-41",
        .requirement =
            "The message of a check error stands in the ID register from the first rejected cycle until "
            "an ID cycle has read it, and only then.",
        .reference = sources::from_memory("dynamic messages in bits 13 to 15, read in the next ID cycle"),
        .details = {details::mark(), details::message({"message_missing", "message_cleared_unread"}),
                    details::status_coding()},
        .stimulus =
            "A clean cycle and an ID cycle; two data cycles with one bit flipped at the slave's receiver; "
            "two ID cycles; such a data cycle, a clean one and an ID cycle.",
        .expected = "No message after the clean cycle; the message in the first ID cycle after the rejected "
                    "ones, also with a clean data cycle between; none in the second.",
        .tags = {"must"},
        .catches = {{"message_never_cleared", "message_not_cleared"},
                    {"message_without_error", "message_without_error"},
                    {"message_cleared_by_data_cycle", "message_cleared_unread"},
                    {"does_not_mark_status", "error_not_marked"},
                    {"tells_no_check_error", "message_missing"}},
        .not_applicable = for_every_slave()},
       check_error_is_told_once});
  add_cases_of_check_errors(cases);
  return cases;
}

}  // namespace fieldproof::conformance
