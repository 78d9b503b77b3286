#include "protocols/interbus/station_timing.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "protocols/interbus/running_network.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::interbus {
namespace {

using kernel::Duration;

NetworkDescription network_of(const char* file) {
  return NetworkDescription::load(std::filesystem::path(FIELDPROOF_SOURCE_DIR) / "examples" / file);
}

// Stations that know nothing of the closed forms: when each one samples, and when it latches.
void expect_instants(const NetworkDescription& network) {
  RunningNetwork live(network);
  ASSERT_TRUE(live.bring_up());
  const Duration cycle = live.status().cycle_time;
  const auto stations = static_cast<int>(live.ring().size());
  std::vector<kernel::Time> sampled(static_cast<std::size_t>(stations));
  for (int position = 1; position <= stations; ++position) {
    if (live.ring().configuration(position).words == 0) continue;
    live.ring().terminals(position).set_signal(0, [&sampled, position](kernel::Time when) {
      sampled[static_cast<std::size_t>(position - 1)] = when;
      return std::uint16_t{0};
    });
  }
  live.keep_starts();
  live.segment().run_for(3 * cycle);
  const auto arrivals = arrival_delays(network);
  ASSERT_EQ(arrivals.size(), sampled.size());
  int compared = 0;
  for (int position = 1; position <= stations; ++position) {
    if (live.ring().configuration(position).words == 0) continue;
    SCOPED_TRACE(live.ring().configuration(position).name);
    const auto n = static_cast<std::size_t>(position - 1);
    // The last cycle may not have reached the last stations yet.
    const Duration behind = sampled[n] - live.data_cycle_starts().back();
    EXPECT_EQ(behind < Duration::zero() ? behind + cycle : behind, arrivals[n]);
    EXPECT_EQ(live.ring().terminals(position).last_write() - sampled[n], sample_to_latch(network));
    ++compared;
  }
  EXPECT_GT(compared, 1);
}

TEST(StationTimingTest, StationsSampleAndLatchWhenTheTheorySays) {
  expect_instants(network_of("paper.json"));
  expect_instants(network_of("paper_printed_reading.json"));
  expect_instants(network_of("mixed_line.json"));
}

TEST(StationTimingTest, AlsoWithOtherDelays) {
  NetworkDescription network = network_of("mixed_line.json");
  network.rules.local_delay_half_bits = 1;
  network.rules.return_delay_half_bits = 5;
  network.rules.cable_delay_ps_per_m = 7'000;
  expect_instants(network);
}

TEST(StationTimingTest, ThePaperNetworkLatchesBehindTenTelegrams) {
  // 9 telegrams with 17 whole bits of gap between them, and one telegram more: 147 bit of 2 us.
  EXPECT_EQ(sample_to_latch(network_of("paper.json")), 294 * kernel::kMicrosecond);
  EXPECT_EQ(sample_to_latch(network_of("paper_printed_reading.json")), 294 * kernel::kMicrosecond);
}

}  // namespace
}  // namespace fieldproof::interbus
