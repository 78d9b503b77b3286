#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_expect.hpp"

#include <fmt/format.h>

// IS-01 and IS-02: before anything is said, and with status telegrams only.
namespace fieldproof::conformance {
namespace {

void is_silent_and_safe(SlaveBench& bench, CaseJudge& judge) {
  bench.silence(100 * kernel::kMillisecond);
  for (LineView* view : {&bench.out(), &bench.remote(), &bench.branch()}) {
    judge.expect(view->data_telegrams().empty(), "data_telegram_without_cause", [&] {
      return Mismatch{.expected = {"no data telegram as long as none arrives"},
                      .actual = describe(*view, view->data_telegrams().front(), kernel::kStart),
                      .time = view->start_of(view->data_telegrams().front())};
    });
  }
  expect_no_change(bench, judge, "output_not_safe_at_power_up", "nothing was received since power-up");
}

// Sends so many status telegrams; each leaves as it came.
void pass_status_telegrams(SlaveBench& bench, CaseJudge& judge, std::size_t count) {
  constexpr std::size_t kTrain = 500;
  for (std::size_t sent = 0; sent < count; sent += kTrain) {
    bench.status_telegrams(kTrain);
    expect_status_telegrams(bench, judge);
    judge.expect(bench.out().data_telegrams().empty(), "data_telegram_without_cause",
                 "status telegrams leave as status telegrams", "a data telegram left");
  }
}

void status_telegrams_pass_without_effect(SlaveBench& bench, CaseJudge& judge) {
  // A second at the pitch of the rules.
  const auto second = static_cast<std::size_t>(bench.rules().bit_rate / bench.rules().status_pitch_bits);
  const std::size_t count = bench.volume<std::size_t>(3000, second);
  pass_status_telegrams(bench, judge, count);
  expect_no_change(bench, judge, "output_changed_by_status_telegram", "status telegrams carry no data");
  bench.bring_up();
  const std::vector<std::uint16_t> words = bench.random_words();
  bench.data_cycle(words);
  expect_outputs(bench, judge, words, "valid_cycle_rejected");
  bench.terminals().forget_changes();
  pass_status_telegrams(bench, judge, count);
  expect_no_change(bench, judge, "output_changed_by_status_telegram",
                   "status telegrams keep the slave alive and carry no data");
  expect_good_cycle(bench, judge, "cycle_after_status_telegrams_rejected");
}

}  // namespace

std::vector<SlaveCase> slave_power_up_cases() {
  std::vector<SlaveCase> cases;
  cases.push_back(
      {{.id = "interbus/slave/power_up/is_silent_and_safe",
        .purpose = "IS-01",
        .requirement =
            "After power-up, before it has received anything, a slave holds its outputs in the safe "
            "state (0) and sends no data telegram.",
        .reference = sources::own("safe state after power-up"),
        .stimulus = "Power is switched on; for 100 ms nothing is sent to the slave.",
        .expected = "No output leaves 0, and no data telegram leaves on any interface.",
        .tags = {"must"},
        .catches = {{"sends_data_at_power_up", "data_telegram_without_cause"},
                    {"outputs_set_at_power_up", "output_not_safe_at_power_up"}},
        .not_applicable = for_every_slave()},
       is_silent_and_safe});
  cases.push_back(
      {{.id = "interbus/slave/power_up/status_telegrams_pass_without_effect",
        .purpose = "IS-02",
        .requirement = "Status telegrams fill the pauses. A slave passes each of them on, shifts nothing, "
                       "leaves its outputs as they are, and takes them for a sign of life.",
        .reference = sources::phoenix_maintenance("status telegrams in every pause"),
        .details = {details::status_coding()},
        .stimulus =
            "One second of status telegrams after power-up; then an ID cycle, a valid data cycle, and "
            "again one second of status telegrams; then a data cycle.",
        .expected = "Each status telegram leaves with the header it came with, no data telegram leaves, no "
                    "output changes, and "
                    "the data cycle after them is accepted without another ID cycle.",
        .tags = {"must"},
        .catches = {{"swallows_status_telegrams", "status_telegram_lost"},
                    {"select_bit_in_status_telegrams", "status_telegram_changed"},
                    {"silence_counts_data_only", "output_changed_by_status_telegram"}},
        .not_applicable = for_every_slave()},
       status_telegrams_pass_without_effect});
  return cases;
}

}  // namespace fieldproof::conformance
