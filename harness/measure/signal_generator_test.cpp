#include "harness/measure/signal_generator.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

using kernel::Duration;
using kernel::kMillisecond;
using kernel::kPicosecond;
using kernel::kStart;
using kernel::Time;

TEST(SignalGeneratorTest, EdgesOfATrainAreExact) {
  SignalGenerator generator({Frequency::from_hertz(50), 250'000, 3 * kMillisecond});
  generator.trigger(kStart + kMillisecond, 2);
  EXPECT_EQ(generator.edges(), (std::vector<Time>{kStart + 4 * kMillisecond, kStart + 9 * kMillisecond,
                                                  kStart + 24 * kMillisecond, kStart + 29 * kMillisecond}));
  EXPECT_EQ(generator.wave().high(), 5 * kMillisecond);
  EXPECT_EQ(generator.pulse_count(), 2U);
  EXPECT_EQ(generator.edge(3), kStart + 24 * kMillisecond);
}

TEST(SignalGeneratorTest, AnEdgeCountsFromItsInstantOn) {
  SignalGenerator generator({Frequency::from_hertz(50)});
  generator.trigger(kStart, 1);
  EXPECT_EQ(generator.edges_until(kStart - kPicosecond), 0U);
  EXPECT_EQ(generator.edges_until(kStart), 1U);
  EXPECT_EQ(generator.edges_until(kStart + 10 * kMillisecond - kPicosecond), 1U);
  EXPECT_EQ(generator.edges_until(kStart + 10 * kMillisecond), 2U);
  EXPECT_EQ(generator.edges_until(kernel::kNever), 2U);
}

TEST(SignalGeneratorTest, TrainsFollowEachOther) {
  SignalGenerator generator({Frequency::from_hertz(50)});
  generator.trigger(kStart, 2);
  EXPECT_THROW(generator.trigger(kStart + 30 * kMillisecond, 1), kernel::BrokenInvariant);
  generator.trigger(kStart + 30 * kMillisecond + kPicosecond, 1);
  EXPECT_EQ(generator.pulse_count(), 3U);
  EXPECT_EQ(generator.pause_count(), 1U);
  EXPECT_FALSE(generator.is_train_end(2));
  EXPECT_TRUE(generator.is_train_end(4));
  EXPECT_FALSE(generator.is_train_end(5));
  EXPECT_TRUE(generator.is_train_end(6));
  EXPECT_THROW(generator.trigger(kernel::kStart + kernel::kSecond, 0), kernel::BrokenInvariant);
}

TEST(SignalGeneratorTest, AWaveWithoutPulseOrPauseIsNone) {
  for (const std::int64_t duty : {0, 1'000'000, -1}) {
    EXPECT_THROW(SignalGenerator({Frequency::from_hertz(50), duty}), kernel::BrokenInvariant);
  }
}

// Rounded once: no edge is further than half a picosecond from where long division puts it.
RC_GTEST_PROP(SignalGeneratorTest, RoundingDoesNotAccumulate, ()) {
  const auto millihertz = *rc::gen::inRange<std::int64_t>(1'000, 2'000'000);
  const auto duty = *rc::gen::inRange<std::int64_t>(1, 1'000'000);
  SignalGenerator generator({Frequency::from_millihertz(millihertz), duty});
  generator.trigger(kStart, 1'000);
  for (const std::int64_t k : {0, 1, 499, 999}) {
    const long double rise = 1e15L * static_cast<long double>(k) / static_cast<long double>(millihertz);
    const long double fall =
        rise + 1e9L * static_cast<long double>(duty) / static_cast<long double>(millihertz);
    const auto at = static_cast<std::uint64_t>(2 * k);
    RC_ASSERT(std::abs(static_cast<long double>((generator.edge(at + 1) - kStart).count()) - rise) < 0.501L);
    RC_ASSERT(std::abs(static_cast<long double>((generator.edge(at + 2) - kStart).count()) - fall) < 0.501L);
  }
}

}  // namespace
}  // namespace fieldproof::measure
