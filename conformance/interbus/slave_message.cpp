#include <utility>

#include "conformance/interbus/slave_scene.hpp"

// IS-34, IS-35, IS-41 and IS-45 to IS-47: what a slave has to report, in the message bits of its ID register.
namespace fieldproof::conformance {
namespace {

using namespace slave_chart;
using interbus::Rules;

constexpr RuleBits kCheckError = &Rules::message_check_error;

SlaveStep no_message(std::string reason, std::string why) {
  return message(nullptr, std::move(reason), std::move(why));
}
SlaveStep none_once_read() {
  return no_message("message_not_cleared", "the message has been read");
}

SlaveStep undisturbed_data_cycles() {
  return {
      "three valid data cycles", "they are answered with a clean status word, their words are at the outputs",
      [](SlaveScene& scene) {
        SlaveBench& bench = scene.bench;
        for (unsigned n = 0; n < 3; ++n) {
          data_cycle().run(scene);
          const std::optional<CycleOnLine> out = bench.cycle_on(bench.out(), 0);
          scene.judge.expect(out && out->status() == bench.rules().status_clean, "data_cycle_disturbed",
                             "a data cycle with a clean status word", "its status word did not leave clean");
          answered().run(scene);
          shown("data_cycle_disturbed").run(scene);
        }
      }};
}

// A condition at the terminals that has to show as one message bit as long as it lasts.
using SetCondition = void (*)(interbus::TerminalBlock&, bool is_on);

SlaveChart condition_chart(std::string begins, std::string ends, SetCondition set, RuleBits bit,
                           std::string reason) {
  const auto setting = [set](std::string text, bool is_on) {
    return stimulus<SlaveScene>(std::move(text),
                                [set, is_on](SlaveScene& scene) { set(scene.bench.terminals(), is_on); });
  };
  return {.rounds = {2, 20},
          .steps = {setting(std::move(begins), true), undisturbed_data_cycles(),
                    message(bit, std::move(reason), "reported in the next ID cycle"),
                    undisturbed_data_cycles(), setting(std::move(ends), false), undisturbed_data_cycles(),
                    stimulus<SlaveScene>(
                        "an ID cycle, which may still read it",
                        [](SlaveScene& scene) { scene.bench.id_cycle(scene.bench.interfaces_off()); }),
                    no_message("message_not_cleared", "it has ended and was read")},
          .first = {identified(), no_message("message_without_cause", "nothing is to be reported")}};
}

void set_peripheral_fault(interbus::TerminalBlock& terminals, bool is_on) {
  terminals.set_peripheral_fault([is_on](kernel::Time) { return is_on; });
}
void set_reconfiguration(interbus::TerminalBlock& terminals, bool is_on) {
  terminals.set_reconfiguration([is_on](kernel::Time) { return is_on; });
}

SlaveChart once_chart() {
  return {.rounds = {2, 20},
          .steps = {good_cycle(), no_message("message_without_error", "no cycle was rejected"), flipped_bit(),
                    rejected(), flipped_bit(), rejected(),
                    message(kCheckError, "message_missing", "two cycles were rejected"), none_once_read(),
                    flipped_bit(), good_cycle(),
                    message(kCheckError, "message_cleared_unread",
                            "a cycle was rejected; the good data cycle after it does not read the message")},
          .first = {identified()}};
}

// A station in front has marked it: the master does not take what it brings back.
void marked_id_cycle(SlaveBench& bench, CaseJudge&) {
  for (unsigned n = 0; n < 2; ++n) {
    bench.begin();
    mark_in_front(bench, bench.append_id_cycle(bench.interfaces_off()));
    bench.send();
  }
}

std::vector<SlaveCase> cases_of_conditions() {
  const judge::Reference visible = sources::from_memory("messages become visible only in an ID cycle");
  return {
      slave_case(
          "messages/peripheral_fault_shows_in_the_next_id_cycle", "IS-34",
          "A fault at the periphery is reported by its message bit in the next ID cycle and by nothing else: "
          "data cycles go on undisturbed.",
          visible,
          {{"peripheral_fault_not_told", "peripheral_fault_not_told"},
           {"peripheral_fault_marks_data_cycles", "data_cycle_disturbed"}},
          condition_chart("the fault input is set", "the fault input is cleared", set_peripheral_fault,
                          &Rules::message_peripheral_fault, "peripheral_fault_not_told"),
          {.details = details::answer(),
           .only_for = for_item("peripheral_fault_input", "the slave has no peripheral fault to report")}),
      slave_case(
          "messages/reconfiguration_button_shows_in_the_next_id_cycle", "IS-35",
          "A request for reconfiguration is reported by its own message bit in the next ID cycle.", visible,
          {{"messages_confused", "reconfiguration_not_told"}},
          condition_chart("the button is pressed", "the button is released", set_reconfiguration,
                          &Rules::message_reconfiguration, "reconfiguration_not_told"),
          {.details = details::answer(),
           .only_for = for_item("reconfiguration_button", "the slave has no reconfiguration button")})};
}

std::vector<SlaveCase> cases_of_check_errors() {
  return {
      slave_case(
          "messages/check_error_is_told_once", "IS-41",
          "The message of a check error stands in the ID register from the first rejected cycle until an ID "
          "cycle has read it, and only then.",
          sources::from_memory("dynamic messages in bits 13 to 15, read in the next ID cycle"),
          {{"message_never_cleared", "message_not_cleared"},
           {"message_without_error", "message_without_error"},
           {"message_cleared_by_data_cycle", "message_cleared_unread"},
           {"does_not_mark_status", "error_not_marked"},
           {"tells_no_check_error", "message_missing"}},
          once_chart(),
          {.details = {details::mark(), details::message({"message_missing", "message_cleared_unread"}),
                       details::status_coding()}}),
      slave_case("messages/marked_id_cycle_leaves_the_message", "IS-45",
                 "Only a good ID cycle clears the message of a check error: what one with a marked status "
                 "word brings back, the master does not take.",
                 sources::own("messages are cleared by having been read by a good ID cycle"),
                 {{"message_cleared_by_marked_id_cycle", "message_cleared_unread"}},
                 {.rounds = {3, 20},
                  .steps = {flipped_bit(),
                            step("two ID cycles whose status word arrives marked", "", marked_id_cycle),
                            message(kCheckError, "message_cleared_unread",
                                    "a cycle was rejected, and both ID cycles after it were marked"),
                            none_once_read()},
                  .first = {identified()}}),
      slave_case("messages/missing_stop_bit_is_told", "IS-46",
                 "A missing stop bit in a data telegram is an error of its cycle: the message of a check "
                 "error stands in the next ID cycle.",
                 sources::own("errors besides the check set the check error message"),
                 {{"tells_no_missing_stop", "message_missing"}, {"stop_bit_not_checked", "message_missing"}},
                 {.steps = {stop_bit_missing(), status_telegrams(2),
                            message(kCheckError, "message_missing", "a telegram of it had no stop bit"),
                            none_once_read()},
                  .first = {identified()},
                  .walk = each_telegram("each telegram of a data cycle", 0)},
                 {.details = {details::message()}}),
      slave_case(
          "messages/other_message_bits_count", "IS-47",
          "The bits of the messages are those that the settings of the case say: those of a check error and "
          "of a peripheral fault are exchanged.",
          sources::own("the message bits are settings"),
          {{"message_bits_hard_coded", "message_missing"}, {"does_not_mark_status", "error_not_marked"}},
          once_chart(),
          {.details = {details::mark(), details::message({"message_missing"})},
           .only_for = for_other_settings(),
           .needs = {.change_rules = [](Rules& rules) {
             std::swap(rules.message_check_error, rules.message_peripheral_fault);
           }}})};
}

}  // namespace

std::vector<SlaveCase> slave_message_cases() {
  return joined({cases_of_conditions(), cases_of_check_errors()});
}

}  // namespace fieldproof::conformance
