#include "conformance/interbus/master_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fieldproof::conformance {

using interbus::CycleFaults;

MasterCase master_case(std::string_view id, std::string_view purpose, std::string_view requirement,
                       judge::Reference reference, std::vector<std::string> tags,
                       std::vector<MustCatch> catches, MasterChart chart) {
  TestCase test_case;
  test_case.id = fmt::format("interbus/master/{}", id);
  test_case.purpose = purpose;
  test_case.requirement = requirement;
  test_case.reference = std::move(reference);
  test_case.tags = std::move(tags);
  test_case.catches = std::move(catches);
  return charted<MasterCase>(std::move(test_case), std::move(chart));
}

MasterCase resting_also_on(PartialSource detail, MasterCase one) {
  one.test_case.details.push_back(std::move(detail));
  return one;
}

namespace master_chart {

MasterStep in_run(std::string where, Ring ring, Prepare prepare) {
  return stimulus<RingScene>("the master runs on " + where,
                             [ring = std::move(ring), prepare](RingScene& scene) {
                               scene.bench.set_script({});
                               if (prepare != nullptr) prepare(scene.bench);
                               scene.bench.bring_up(scene.judge, ring);
                             });
}

MasterStep in_run(Prepare prepare) {
  return in_run("a coupler with an input and an output terminal", paper_ring(), prepare);
}

MasterStep data_cycles(unsigned count) {
  return stimulus<RingScene>(fmt::format("{} data cycles", count),
                             [count](RingScene& scene) { scene.bench.run_data_cycles(scene.judge, count); });
}

Walk<RingScene> each(std::string over, std::size_t count) {
  return {std::move(over), [count](RingScene&) { return count; }};
}

void spoil(CycleFaults& faults) {
  faults.flips = {{0, 0x01, false}};
}

void expect_next_cycle(MasterBench& bench, CaseJudge& judge) {
  judge.expect(bench.run_cycle(), "no_data_cycle", "cycles go on", "no cycle ends");
}

MasterStep rejected(std::string how, std::string reason, MakeFaults faults) {
  return {"a data cycle comes back with " + how, "it is rejected, the inputs stay",
          [how, reason = std::move(reason), faults = std::move(faults)](RingScene& scene) {
            CycleFaults suffers;
            faults(scene, suffers);
            const std::string what = fmt::format("{} ({})", how, text_of(suffers));
            scene.suffered = scene.bench.suffer(scene.judge, std::move(suffers));
            const auto& [is_accepted, held, offered, seen, id_cycles] = scene.suffered;
            scene.judge.expect(!is_accepted, reason, what + ": rejected", "the cycle is accepted");
            scene.judge.expect(seen == held, "rejected_inputs_seen",
                               fmt::format("{}: the inputs before, {:04X}h", what, fmt::join(held, "h ")),
                               fmt::format("{:04X}h", fmt::join(seen, "h ")));
          }};
}

void expect_cycle_time_without_words(MasterBench& bench, CaseJudge& judge, std::size_t stations,
                                     kernel::Duration of_cable, std::string_view reason) {
  constexpr std::int64_t kTelegrams = 6;  // loopback word, check and status
  const interbus::Rules& rules = bench.rules();
  const std::int64_t half_bits =
      static_cast<std::int64_t>(stations) * (rules.forward_delay_half_bits + rules.return_delay_half_bits);
  const kernel::Duration right =
      kernel::levels_duration(kTelegrams * (13'000 + rules.telegram_gap_millibits), 1'000 * rules.bit_rate) +
      kernel::levels_duration(half_bits, 2 * rules.bit_rate) + of_cable + rules.software_time;
  bench.ring().forget_statistics();
  bench.run_data_cycles(judge, 4);
  const kernel::Duration seen = bench.ring().statistics().longest_cycle;
  judge.expect(right - right / 50 <= seen && seen <= right + right / 50, reason,
               fmt::format("a cycle time of {} within 2 %", kernel::describe(right)), kernel::describe(seen));
}

MasterStep configuration_error(std::string text, std::string reason) {
  return expected<RingScene>(text, [text, reason = std::move(reason)](RingScene& scene) {
    const auto status = scene.bench.status();
    scene.judge.expect(!scene.bench.is_in_run() && !status.configuration_error.empty(), reason, text,
                       scene.bench.is_in_run() ? "the master runs" : "no configuration error");
  });
}

}  // namespace master_chart
}  // namespace fieldproof::conformance
