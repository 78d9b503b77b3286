#include "harness/measure/edge_skew.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

namespace fieldproof::measure {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kStart;

class EdgeSkewTest : public testing::Test {
 protected:
  EdgeSkewTest() { generator_.trigger(kStart, 3); }

  void show(std::int64_t microseconds, std::uint64_t edge) {
    recorder_.on_output(kStart + microseconds * kMicrosecond, EdgeCode().word(edge));
  }

  SignalGenerator generator_{{Frequency::from_hertz(50)}};  // edges 1 to 6 at 0, 10 ... 50 ms
  TwoChannelRecorder recorder_{generator_};
};

TEST_F(EdgeSkewTest, EveryEdgeHasItsDelayAndEveryPulseItsWidth) {
  show(1'000, 1);
  show(13'000, 2);  // the pulse is 2 ms longer
  show(21'000, 3);
  show(31'000, 4);
  show(42'000, 5);
  show(51'500, 6);  // half a millisecond shorter
  const EdgeSkew skew = edge_skew(recorder_);
  EXPECT_EQ(skew.pulses, 3U);
  EXPECT_EQ(skew.lost_pulses, 0U);
  EXPECT_EQ(skew.lost_pauses, 0U);
  const Distribution rises = skew.rise_delays.total();
  EXPECT_EQ(rises.count(), 3U);
  EXPECT_EQ(rises.min(), Duration(kMillisecond).count());
  EXPECT_EQ(rises.max(), Duration(2 * kMillisecond).count());
  EXPECT_EQ(skew.fall_delays.total().max(), Duration(3 * kMillisecond).count());
  EXPECT_EQ(skew.fall_delays.total().count(), 2U);  // the last edge belongs to the rest behind the train
  EXPECT_EQ(skew.pauses, 2U);
  EXPECT_EQ(skew.widths.total().max(), Duration(12 * kMillisecond).count());
  EXPECT_EQ(skew.width_errors.total().min(), Duration(-500 * kMicrosecond).count());
  EXPECT_EQ(skew.duty_errors_ppm.total().max(), 100'000);  // 2 ms of 20 ms
  EXPECT_EQ(skew.duty_errors_ppm.total().min(), -25'000);
}

TEST_F(EdgeSkewTest, ALostPulseAndALostPauseAreCounted) {
  show(1'000, 1);
  show(22'000, 3);  // the pause behind edge 2 never came
  show(33'000, 4);
  show(55'000, 6);  // the pulse of edge 5 never came
  const EdgeSkew skew = edge_skew(recorder_);
  EXPECT_EQ(skew.lost_pulses, 1U);
  EXPECT_EQ(skew.lost_pauses, 1U);
  // Two pulses that the output shows as one are told apart.
  EXPECT_EQ(skew.widths.total().count(), 2U);
  EXPECT_EQ(skew.widths.total().max(), Duration(21 * kMillisecond).count());
}

TEST_F(EdgeSkewTest, AnUnfinishedPulseHasNoWidth) {
  show(1'000, 1);
  const EdgeSkew skew = edge_skew(recorder_);
  EXPECT_EQ(skew.rise_delays.total().count(), 1U);
  EXPECT_TRUE(skew.widths.total().is_empty());
  EXPECT_EQ(skew.lost_pulses, 2U);
  EXPECT_EQ(skew.lost_pauses, 2U);
}

TEST_F(EdgeSkewTest, NothingShownIsAllLost) {
  EXPECT_EQ(edge_skew(recorder_).lost_pulses, 3U);
  recorder_.on_output(kStart, 0x1234);
  EXPECT_EQ(edge_skew(recorder_).foreign_words, 1U);
}

TEST_F(EdgeSkewTest, APhaseIsThatOfTheWholeWay) {
  show(1'000, 1);
  show(13'000, 2);
  show(21'000, 3);
  show(31'000, 4);
  const auto burst_at_12_ms = [](kernel::Time from, kernel::Time to) {
    const kernel::Time burst = kStart + 12 * kMillisecond;
    return from <= burst && burst <= to ? Phase::burst : Phase::quiet;
  };
  const EdgeSkew skew = edge_skew(recorder_, burst_at_12_ms);
  EXPECT_EQ(skew.rise_delays.in(Phase::burst).count(), 0U);
  EXPECT_EQ(skew.fall_delays.in(Phase::burst).count(), 1U);
  EXPECT_EQ(skew.widths.in(Phase::burst).count(), 1U);
  EXPECT_EQ(skew.widths.in(Phase::quiet).count(), 1U);
}

// A line that delays every edge by the same time changes nothing but the delay.
RC_GTEST_PROP(EdgeSkewPropertyTest, AConstantDelayDistortsNothing, ()) {
  const auto millihertz = *rc::gen::inRange<std::int64_t>(1'000, 1'000'000);
  const Duration delay{*rc::gen::inRange<std::int64_t>(0, 10'000'000'000)};
  SignalGenerator generator(
      {Frequency::from_millihertz(millihertz), *rc::gen::inRange<std::int64_t>(1, 1'000'000)});
  generator.trigger(kStart, 20);
  TwoChannelRecorder recorder(generator);
  for (std::uint64_t n = 1; n <= 40; ++n) recorder.on_output(generator.edge(n) + delay, EdgeCode().word(n));
  const EdgeSkew skew = edge_skew(recorder);
  RC_ASSERT(skew.rise_delays.total().min() == delay.count());
  RC_ASSERT(skew.fall_delays.total().max() == delay.count());
  RC_ASSERT(skew.width_errors.total().min() == 0);
  RC_ASSERT(skew.width_errors.total().max() == 0);
  RC_ASSERT(skew.lost_pulses + skew.lost_pauses + skew.foreign_words == 0U);
}

}  // namespace
}  // namespace fieldproof::measure
