#include "protocols/interbus/live_network.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "protocols/interbus/timing.hpp"

namespace fieldproof::interbus {
namespace {

NetworkDescription example(const char* file) {
  return NetworkDescription::load(std::filesystem::path(FIELDPROOF_SOURCE_DIR) / "examples" / file);
}

TEST(LiveNetworkTest, TellsWhenDataCyclesStart) {
  LiveNetwork live(example("mixed_line.json"));
  ASSERT_TRUE(live.bring_up());
  const kernel::Duration cycle = live.status().cycle_time;
  live.forget_starts();
  const std::uint64_t before = live.status().data_cycles;
  live.segment().run_for(20 * cycle);
  const auto& starts = live.data_cycle_starts();
  EXPECT_EQ(starts.size(), 20U);
  EXPECT_EQ(live.status().data_cycles - before, 20U);
  for (std::size_t n = 1; n < starts.size(); ++n) EXPECT_EQ(starts[n] - starts[n - 1], cycle);
}

TEST(LiveNetworkTest, AnIdCycleIsNoDataCycle) {
  LiveNetwork live(example("paper.json"));
  ASSERT_TRUE(live.bring_up());
  const kernel::Duration cycle = live.status().cycle_time;
  live.forget_starts();
  live.master().request_id_cycle();
  const std::uint64_t before = live.status().data_cycles;
  live.segment().run_for(10 * cycle);
  EXPECT_EQ(live.data_cycle_starts().size(), live.status().data_cycles - before);
  EXPECT_LT(live.data_cycle_starts().size(), 10U);
}

TEST(LiveNetworkTest, ANetworkThatIsCutDoesNotComeUp) {
  LiveNetwork live(example("paper.json"));
  live.ring().set_cable(1, false);
  EXPECT_FALSE(live.bring_up());
}

// The closed forms of timing.hpp against stations that know nothing of them: when each one samples, and when
// it latches.
void expect_instants(const NetworkDescription& network) {
  LiveNetwork live(network);
  ASSERT_TRUE(live.bring_up());
  EXPECT_EQ(live.status().cycle_time, structural_cycle_time(network));
  const auto stations = static_cast<int>(live.ring().size());
  std::vector<kernel::Time> sampled(static_cast<std::size_t>(stations));
  for (int position = 1; position <= stations; ++position) {
    if (live.ring().configuration(position).words == 0) continue;
    live.ring().terminals(position).set_signal(0, [&sampled, position](kernel::Time when) {
      sampled[static_cast<std::size_t>(position - 1)] = when;
      return std::uint16_t{0};
    });
  }
  live.segment().run_for(3 * live.status().cycle_time);
  const auto arrivals = arrival_delays(network);
  const kernel::Duration way = sample_to_latch(network.rules, timing_input(network).user_octets);
  ASSERT_EQ(arrivals.size(), sampled.size());
  int compared = 0;
  for (int position = 1; position <= stations; ++position) {
    if (live.ring().configuration(position).words == 0) continue;
    SCOPED_TRACE(live.ring().configuration(position).name);
    const auto n = static_cast<std::size_t>(position - 1);
    // The last cycle may not have reached the last stations yet.
    const kernel::Duration behind = sampled[n] - live.data_cycle_starts().back();
    const kernel::Duration cycle = live.status().cycle_time;
    EXPECT_EQ(behind < kernel::Duration::zero() ? behind + cycle : behind, arrivals[n]);
    EXPECT_EQ(live.ring().terminals(position).last_write() - sampled[n], way);
    ++compared;
  }
  EXPECT_GT(compared, 1);
}

TEST(LiveNetworkTest, StationsSampleAndLatchWhenTheTheorySays) {
  expect_instants(example("paper.json"));
  expect_instants(example("paper_printed_reading.json"));
  expect_instants(example("mixed_line.json"));
}

TEST(LiveNetworkTest, AlsoWithDelaysOnTheLocalBus) {
  NetworkDescription network = example("mixed_line.json");
  network.rules.local_delay_half_bits = 1;
  network.rules.return_delay_half_bits = 5;
  expect_instants(network);
}

}  // namespace
}  // namespace fieldproof::interbus
