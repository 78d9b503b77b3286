#include <fmt/format.h>

#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_expect.hpp"

// IS-27 to IS-29 and IS-48 to IS-50: silence on the line.
namespace fieldproof::conformance {
namespace {

// Brings outputs that are not 0 and gives the end of the last telegram at the slave's receiver.
kernel::Time last_sign_of_life(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  std::vector<std::uint16_t> words = bench.random_words();
  for (std::uint16_t& word : words) word |= 0x8001;
  bench.data_cycle(words);
  expect_outputs(bench, judge, words, "valid_cycle_rejected");
  bench.status_telegrams(3);
  bench.terminals().forget_changes();
  return bench.in().telegrams().empty() ? bench.now() : bench.in().end_of(bench.in().telegrams().back());
}

void short_silence_holds_outputs(SlaveBench& bench, CaseJudge& judge) {
  const kernel::Time last = last_sign_of_life(bench, judge);
  const kernel::Duration silence = bench.rules().silence_limit - bench.rules().silence_tolerance;
  bench.segment().run_until(last + silence);
  expect_no_change(bench, judge, "outputs_lost_before_limit",
                   fmt::format("the line was silent for {} only", kernel::describe(silence)));
  expect_good_cycle(bench, judge, "cycle_after_short_silence_rejected");
}

void long_silence_clears_outputs(SlaveBench& bench, CaseJudge& judge) {
  const kernel::Time last = last_sign_of_life(bench, judge);
  const kernel::Duration limit = bench.rules().silence_limit;
  const kernel::Duration latest = limit + bench.rules().silence_tolerance;
  bench.segment().run_until(last + latest);
  expect_outputs(bench, judge, std::vector<std::uint16_t>(bench.words()), "outputs_not_safe_after_limit");
  for (const auto& change : bench.changes()) {
    const kernel::Duration after = change.when - last;
    const auto sighting = [&] {
      return Mismatch{.expected = {fmt::format("outputs change {} to {} after the last telegram",
                                               kernel::describe(limit), kernel::describe(latest))},
                      .actual = fmt::format("after {}", kernel::describe(after)),
                      .time = change.when};
    };
    judge.expect(after >= limit, "outputs_lost_before_limit", sighting);
    judge.expect(after <= latest, "outputs_not_safe_after_limit", sighting);
  }
  if (!bench.changes().empty()) {
    judge.measure("silence until the safe state", "ms",
                  static_cast<double>((bench.changes().back().when - last).count()) / 1e9);
  }
}

void drive_data_cycle(SlaveBench& bench) {
  std::vector<std::uint16_t> words = bench.random_words();
  for (std::uint16_t& word : words) word |= 1;
  line::Waveform wave{bench.now(), bench.rules().bit_rate, bench.direct_data_cycle(words, 2)};
  bench.drive_at_receiver(wave);
}

void outputs_stay_safe_without_identification(SlaveBench& bench, CaseJudge& judge) {
  const std::string_view reason = "outputs_driven_before_identification";
  for (unsigned n = 0; n < 3; ++n) drive_data_cycle(bench);
  expect_no_change(bench, judge, reason, "no ID cycle has been since power-up");
  for (unsigned round = 0; round < bench.volume(2U, 10U); ++round) {
    last_sign_of_life(bench, judge);
    bench.silence(bench.rules().silence_limit + bench.rules().silence_tolerance);
    expect_outputs(bench, judge, std::vector<std::uint16_t>(bench.words()), "outputs_not_safe_after_limit");
    bench.terminals().forget_changes();
    for (unsigned n = 0; n < 3; ++n) drive_data_cycle(bench);
    expect_no_change(bench, judge, reason, "no ID cycle has been since the silence");
  }
  bench.bring_up();
  expect_good_cycle(bench, judge, "no_recovery");
}

// ---- what is after OUT1 ----

std::vector<std::uint16_t> neighbour_words_of_ones(SlaveBench& bench) {
  return std::vector<std::uint16_t>(bench.neighbour_words(false), 0xFFFF);
}

void open_remote(SlaveBench& bench, CaseJudge& judge) {
  bench.bring_up();
  bench.id_cycle(bench.rules().control_local_off);
  std::vector<std::uint16_t> words = bench.random_words();
  for (std::uint16_t& word : words) word |= 0x8001;
  bench.data_cycle(words, neighbour_words_of_ones(bench));
  judge.expect(bench.remote().data_telegrams().size() == bench.in().data_telegrams().size(),
               "interface_not_opened", "the data cycle goes out on OUT1", "it did not go out whole");
  expect_outputs(bench, judge, words, "valid_cycle_rejected");
  bench.terminals().forget_changes();
}

void reset_switches_interfaces_off(SlaveBench& bench, CaseJudge& judge) {
  for (unsigned round = 0; round < bench.volume(2U, 10U); ++round) {
    open_remote(bench, judge);
    bench.silence(bench.rules().silence_limit + bench.rules().silence_tolerance);
    for (unsigned n = 0; n < 3; ++n) {
      drive_data_cycle(bench);
      judge.expect(bench.remote().waves().empty(), "interfaces_on_after_reset", [&] {
        return Mismatch{.expected = {"nothing leaves on OUT1: no ID cycle has been since the reset"},
                        .actual = fmt::format("{} telegrams left on OUT1", bench.remote().telegrams().size()),
                        .time = bench.remote().waves().front().start};
      });
      expect_all_telegrams(bench, judge);
    }
  }
}

void returns_are_no_sign_of_life(SlaveBench& bench, CaseJudge& judge) {
  open_remote(bench, judge);
  bench.status_telegrams(3);
  const kernel::Time last =
      bench.in().telegrams().empty() ? bench.now() : bench.in().end_of(bench.in().telegrams().back());
  const kernel::Time latest = last + bench.rules().silence_limit + bench.rules().silence_tolerance;
  while (bench.now() + kernel::kMillisecond < latest) {
    TrainWriter writer(bench.rules());
    writer.status(3);
    line::Waveform wave{bench.now(), bench.rules().bit_rate, writer.levels()};
    bench.drive_return(false, wave);
    bench.silence(kernel::kMillisecond);
  }
  bench.segment().run_until(latest);
  expect_outputs(bench, judge, std::vector<std::uint16_t>(bench.words()), "outputs_not_safe_after_limit");
}

SlaveNeeds with_a_station_after_out1() {
  return {.id_code = {}, .remote_neighbour = true};
}

void add_cases_of_out1(std::vector<SlaveCase>& cases) {
  const Applicability for_remote =
      for_item("remote_interface", "the slave has no outgoing remote-bus interface (OUT1)");
  cases.push_back(
      {{.id = "interbus/slave/supervision/reset_switches_the_interfaces_off",
        .purpose = "IS-48",
        .requirement = "A reset switches the outgoing interfaces off, as at power-up, until an ID cycle "
                       "switches them on.",
        .reference = sources::own("a reset is outputs 0 and interfaces off"),
        .stimulus = "OUT1 is switched on; a silence of 26 ms; data cycles.",
        .expected = "Nothing leaves on OUT1; the data cycles return from the slave itself.",
        .tags = {"must"},
        .catches = {{"reset_leaves_interfaces_on", "interfaces_on_after_reset"}},
        .not_applicable = for_remote},
       reset_switches_interfaces_off,
       with_a_station_after_out1()});
  cases.push_back(
      {{.id = "interbus/slave/supervision/returns_are_no_sign_of_life",
        .purpose = "IS-49",
        .requirement = "Supervised is the line from the master: what comes back from after an outgoing "
                       "interface is no sign of life.",
        .reference = sources::own("silence is that of port 0"),
        .stimulus = "OUT1 is switched on; then silence from the master's side, while status telegrams "
                    "come back from OUT1 each millisecond.",
        .expected = "All outputs are 0 after 26 ms.",
        .tags = {"must", "timing"},
        .catches = {{"kept_alive_by_returns", "outputs_not_safe_after_limit"}},
        .not_applicable = for_all({for_outputs(), for_remote})},
       returns_are_no_sign_of_life,
       with_a_station_after_out1()});
}

SlaveCase other_limit_case() {
  return {{.id = "interbus/slave/supervision/another_silence_limit_counts",
           .purpose = "IS-50",
           .requirement = "The limit of the silence is the one that the settings of the case say.",
           .reference = sources::own("the silence limit is a setting"),
           .stimulus = "A valid data cycle, status telegrams, then silence; the silence limit is 10 ms.",
           .expected = "All outputs are 0 between 10.0 ms and 11.0 ms after the end of the last telegram.",
           .tags = {"must", "timing"},
           .catches = {{"silence_limit_hard_coded", "outputs_not_safe_after_limit"}},
           .not_applicable = for_all({for_outputs(), for_other_settings()})},
          long_silence_clears_outputs,
          {.change_rules = [](interbus::Rules& rules) { rules.silence_limit = 10 * kernel::kMillisecond; }}};
}

}  // namespace

std::vector<SlaveCase> slave_supervision_cases() {
  std::vector<SlaveCase> cases;
  cases.push_back(
      {{.id = "interbus/slave/supervision/silence_of_24_ms_holds_outputs",
        .purpose = "IS-27",
        .requirement =
            "Silence shorter than the supervision time of 25 ms changes nothing: outputs hold, and the "
            "cycle after it is a normal one.",
        .reference = sources::phoenix_maintenance("status telegrams away for more than 25 ms"),
        .details = {details::status_coding()},
        .stimulus = "A valid data cycle, status telegrams, 24.0 ms of silence, a data cycle.",
        .expected = "No output changes in the silence, and the data cycle is taken over without an ID cycle.",
        .tags = {"must", "timing"},
        .catches = {{"silence_limit_20_ms", "outputs_lost_before_limit"}},
        .not_applicable = for_outputs()},
       short_silence_holds_outputs});
  cases.push_back(
      {{.id = "interbus/slave/supervision/silence_of_26_ms_clears_outputs",
        .purpose = "IS-28",
        .requirement =
            "When telegrams stay away for more than 25 ms, the slave takes the interruption for a reset "
            "and its outputs go to the safe state. The tolerance of 1 ms is this project's.",
        .reference = sources::phoenix_maintenance("status telegrams away for more than 25 ms"),
        .details = {{sources::own("the tolerance of 1 ms"), {"outputs_not_safe_after_limit"}}},
        .stimulus = "A valid data cycle, status telegrams, then silence.",
        .expected = "All outputs are 0 between 25.0 ms and 26.0 ms after the end of the last telegram.",
        .tags = {"must", "timing"},
        .catches = {{"silence_limit_250_ms", "outputs_not_safe_after_limit"},
                    {"safe_state_500_ms_late", "outputs_not_safe_after_limit"},
                    {"silence_limit_20_ms", "outputs_lost_before_limit"}},
        .not_applicable = for_outputs()},
       long_silence_clears_outputs});
  cases.push_back(
      {{.id = "interbus/slave/supervision/outputs_stay_safe_until_an_id_cycle",
        .purpose = "IS-29",
        .requirement =
            "After power-up and after a reset, outputs stay in the safe state until an ID cycle has "
            "shown the master what is in the ring.",
        .reference = sources::own("data cycles count only after identification"),
        .details = {details::status_coding()},
        .stimulus =
            "Valid data cycles right after power-up, and after a silence of 26 ms; then an ID cycle and a "
            "data cycle.",
        .expected = "No output changes by the data cycles without ID cycle; the one after it is taken over.",
        .tags = {"must"},
        .catches = {{"outputs_without_identification", "outputs_driven_before_identification"}},
        .not_applicable = for_outputs()},
       outputs_stay_safe_without_identification});
  add_cases_of_out1(cases);
  cases.push_back(other_limit_case());
  return cases;
}

}  // namespace fieldproof::conformance
