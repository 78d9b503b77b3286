#include "conformance/interbus/slave_scene.hpp"

// IS-01 and IS-02: before anything is sent, and with status telegrams only.
namespace fieldproof::conformance {
namespace {

using namespace slave_chart;

void no_data_telegram(SlaveBench& bench, CaseJudge& judge) {
  for (LineView* view : {&bench.out(), &bench.remote(), &bench.branch()}) {
    judge.expect(view->data_telegrams().empty(), "data_telegram_without_cause", [&] {
      const SeenTelegram& first = view->data_telegrams().front();
      return Mismatch{.expected = {"no data telegram as long as none arrives"},
                      .actual = describe(*view, first, kernel::kStart),
                      .time = view->start_of(first)};
    });
  }
}

SlaveStep second_of_status_telegrams() {
  return {"one second of status telegrams",
          "each leaves with the header it came with, no data telegram leaves, no output changes",
          [](SlaveScene& scene) {
            SlaveBench& bench = scene.bench;
            constexpr std::size_t kTrain = 500;
            const auto second =
                static_cast<std::size_t>(bench.rules().bit_rate / bench.rules().status_pitch_bits);
            for (std::size_t sent = 0; sent < bench.volume<std::size_t>(3000, second); sent += kTrain) {
              bench.status_telegrams(kTrain);
              expect_status_telegrams(bench, scene.judge);
              scene.judge.expect(bench.out().data_telegrams().empty(), "data_telegram_without_cause",
                                 "status telegrams leave as status telegrams", "a data telegram left");
            }
            expect_no_change(bench, scene.judge, "output_changed_by_status_telegram",
                             "status telegrams keep the slave alive and carry no data");
          }};
}

}  // namespace

std::vector<SlaveCase> slave_power_up_cases() {
  return {slave_case(
              "power_up/is_silent_and_safe", "IS-01",
              "After power-up, before it has received anything, a slave holds its outputs in the safe state "
              "(0) and sends no data telegram.",
              sources::own("safe state after power-up"),
              {{"sends_data_at_power_up", "data_telegram_without_cause"},
               {"outputs_set_at_power_up", "output_not_safe_at_power_up"}},
              {.steps = {silence("power is switched on; for 100 ms nothing is sent to the slave",
                                 [](const interbus::Rules&) { return 100 * kernel::kMillisecond; }),
                         step("", "no data telegram leaves on any interface", no_data_telegram),
                         unchanged("output_not_safe_at_power_up", "nothing was received since power-up")}}),
          slave_case(
              "power_up/status_telegrams_pass_without_effect", "IS-02",
              "Status telegrams fill the pauses. A slave passes each of them on, shifts nothing, leaves its "
              "outputs as they are, and takes them for a sign of life.",
              sources::phoenix_maintenance("status telegrams in every pause"),
              {{"swallows_status_telegrams", "status_telegram_lost"},
               {"select_bit_in_status_telegrams", "status_telegram_changed"},
               {"silence_counts_data_only", "output_changed_by_status_telegram"}},
              {.steps = {second_of_status_telegrams(), identified(), good_cycle(),
                         second_of_status_telegrams(), good_cycle("cycle_after_status_telegrams_rejected")}},
              {.details = {details::status_coding()}})};
}

}  // namespace fieldproof::conformance
