#include "protocols/interbus/running_network.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace fieldproof::interbus {
namespace {

NetworkDescription example(const char* file) {
  return NetworkDescription::load(std::filesystem::path(FIELDPROOF_SOURCE_DIR) / "examples" / file);
}

TEST(RunningNetworkTest, TellsWhenDataCyclesStart) {
  RunningNetwork live(example("mixed_line.json"));
  ASSERT_TRUE(live.bring_up());
  const kernel::Duration cycle = live.status().cycle_time;
  live.keep_starts();
  const std::uint64_t before = live.status().data_cycles;
  live.segment().run_for(20 * cycle);
  const auto& starts = live.data_cycle_starts();
  EXPECT_EQ(starts.size(), 20U);
  EXPECT_EQ(live.status().data_cycles - before, 20U);
  for (std::size_t n = 1; n < starts.size(); ++n) EXPECT_EQ(starts[n] - starts[n - 1], cycle);
}

TEST(RunningNetworkTest, AnIdCycleIsNoDataCycle) {
  RunningNetwork live(example("paper.json"));
  ASSERT_TRUE(live.bring_up());
  const kernel::Duration cycle = live.status().cycle_time;
  live.keep_starts();
  live.master().request_id_cycle(live.segment().now());
  const std::uint64_t before = live.status().data_cycles;
  live.segment().run_for(10 * cycle);
  EXPECT_EQ(live.data_cycle_starts().size(), live.status().data_cycles - before);
  EXPECT_LT(live.data_cycle_starts().size(), 10U);
}

TEST(RunningNetworkTest, ANetworkThatIsCutDoesNotComeUp) {
  RunningNetwork live(example("paper.json"));
  live.ring().set_cable(1, false);
  EXPECT_FALSE(live.bring_up());
}

}  // namespace
}  // namespace fieldproof::interbus
