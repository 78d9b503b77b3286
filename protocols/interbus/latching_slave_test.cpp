#include "protocols/interbus/latching_slave.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/running_network.hpp"
#include "protocols/interbus/station_timing.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::interbus {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr int kInputStation = 2;
constexpr int kOutputStation = 3;

// From the only edge at the input, `after_start` after the start of a data cycle, to the output.
Duration delay_of(LatchModel model, Duration after_start) {
  const NetworkDescription network = paper_network();
  const Duration way = sample_to_latch(network);
  RunningNetwork live(network, {.make_slave = [&](int, const SlaveConfiguration& configuration) {
                        return std::make_unique<LatchingSlave>(configuration, model, way);
                      }});
  EXPECT_TRUE(live.bring_up());
  live.keep_starts();
  live.segment().run_for(3 * live.status().cycle_time);
  const Time edge = live.data_cycle_starts().back() + 2 * live.status().cycle_time + after_start;
  live.ring().terminals(kInputStation).set_signal(0, [=](Time when) -> std::uint16_t {
    return when >= edge;
  });
  live.ring().terminals(kOutputStation).forget_changes();
  live.segment().run_for(8 * live.status().cycle_time);
  const auto& changes = live.ring().terminals(kOutputStation).changes();
  EXPECT_EQ(changes.size(), 1U);
  return changes.empty() ? Duration::zero() : changes.front().when - edge;
}

class LatchingSlaveTest : public testing::Test {
 protected:
  NetworkDescription network_ = paper_network();
  Duration cycle_ = structural_cycle_time(network_);
  Duration frame_ = sample_to_latch(network_);
  Duration arrival_ = arrival_delays(network_).at(kInputStation - 1);
};

// An edge just at a sample, and one a picosecond after it, for which the next sample is a cycle away.
TEST_F(LatchingSlaveTest, FrameEdgesSamplesAtTheStartOfTheFrame) {
  EXPECT_EQ(delay_of(LatchModel::frame_edges, arrival_), cycle_ + frame_);
  EXPECT_EQ(delay_of(LatchModel::frame_edges, arrival_ + kernel::kPicosecond),
            2 * cycle_ + frame_ - kernel::kPicosecond);
}

TEST_F(LatchingSlaveTest, PreviousFrameSamplesAtItsEnd) {
  EXPECT_EQ(delay_of(LatchModel::previous_frame, arrival_ + frame_), 2 * cycle_);
  EXPECT_EQ(delay_of(LatchModel::previous_frame, arrival_ + frame_ + kernel::kPicosecond),
            3 * cycle_ - kernel::kPicosecond);
}

TEST_F(LatchingSlaveTest, SameInstantSamplesWhereOutputsAreLatched) {
  EXPECT_EQ(delay_of(LatchModel::same_instant, arrival_ + frame_), cycle_);
  EXPECT_EQ(delay_of(LatchModel::same_instant, arrival_ + frame_ + kernel::kPicosecond),
            2 * cycle_ - kernel::kPicosecond);
}

}  // namespace
}  // namespace fieldproof::interbus
