#include "emc/effective_time.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

namespace fieldproof::emc {
namespace {

using kernel::Duration;
using kernel::kNanosecond;
using line::Sampling;

Duration effective(Duration tau, Sampling sampling, std::int64_t bit_rate = 500'000) {
  const std::vector<Interval> wrong{{40 * kNanosecond, 40 * kNanosecond + tau}};
  return effective_time(wrong, sampling, bit_rate);
}

// At 500 kbit/s a sixteenth of a bit is 125 ns.
TEST(EffectiveTimeTest, FollowsThePiecewiseForm) {
  for (int tau = 1; tau <= 124; ++tau)
    EXPECT_EQ(effective(tau * kNanosecond, line::kMajorityOfThree), Duration{}) << tau;
  EXPECT_EQ(effective(125 * kNanosecond, line::kMajorityOfThree), Duration{});
  EXPECT_EQ(effective(126 * kNanosecond, line::kMajorityOfThree), 2 * kNanosecond);
  EXPECT_EQ(effective(150 * kNanosecond, line::kMajorityOfThree), 50 * kNanosecond);
  EXPECT_EQ(effective(249 * kNanosecond, line::kMajorityOfThree), 248 * kNanosecond);
  EXPECT_EQ(effective(250 * kNanosecond, line::kMajorityOfThree), 250 * kNanosecond);
  EXPECT_EQ(effective(700 * kNanosecond, line::kMajorityOfThree), 700 * kNanosecond);
  for (const int tau : {1, 100, 300, 1000}) {
    EXPECT_EQ(effective(tau * kNanosecond, line::kMidBit), tau * kNanosecond);
  }
}

// The longest time that three votes do not see, per bit rate.
TEST(EffectiveTimeTest, ImmunityEndsAtASixteenthOfABit) {
  for (const auto& [bit_rate, immune] : {std::pair<std::int64_t, Duration>{500'000, 125 * kNanosecond},
                                         {375'000, 166 * kNanosecond},
                                         {62'500, 1000 * kNanosecond},
                                         {19'200, 3255 * kNanosecond}}) {
    EXPECT_EQ(effective(immune, line::kMajorityOfThree, bit_rate), Duration{});
    EXPECT_GT(effective(immune + kNanosecond, line::kMajorityOfThree, bit_rate), Duration{});
  }
}

// Several intervals: two samples may be wrong in different ones.
RC_GTEST_PROP(EffectiveTimeProperty, IsWhatCountingPhasesGives, ()) {
  std::vector<Interval> wrong;
  Duration at{};
  const int count = *rc::gen::inRange(0, 5);
  for (int n = 0; n < count; ++n) {
    at += *rc::gen::inRange(1, 300) * kNanosecond;
    const Duration to = at + *rc::gen::inRange(1, 300) * kNanosecond;
    wrong.push_back({at, to});
    at = to;
  }
  const auto is_wrong = [&](Duration t) {
    for (const Interval& interval : wrong) {
      if (interval.from <= t && t < interval.to) return 1;
    }
    return 0;
  };
  Duration majority{};
  Duration single{};
  const Duration pitch = 125 * kNanosecond;
  for (Duration phase = -2 * pitch; phase < at; phase += kNanosecond) {
    single += is_wrong(phase) * kNanosecond;
    if (is_wrong(phase) + is_wrong(phase + pitch) + is_wrong(phase + 2 * pitch) >= 2) majority += kNanosecond;
  }
  RC_ASSERT(effective_time(wrong, line::kMajorityOfThree, 500'000) == majority);
  RC_ASSERT(effective_time(wrong, line::kMidBit, 500'000) == single);
}

TEST(EffectiveTimeTest, FlipsPerPulseAreHalfOfTheTimeForOneLevel) {
  WrongOutput wrong;
  wrong.of_level[1] = {{{}, 300 * kNanosecond}};
  EXPECT_DOUBLE_EQ(flips_per_pulse(wrong, line::kMidBit, 500'000), 0.075);
  wrong.of_level[0] = wrong.of_level[1];
  EXPECT_DOUBLE_EQ(flips_per_pulse(wrong, line::kMajorityOfThree, 500'000), 0.15);
}

TEST(EffectiveTimeTest, TheFitHasTheParametersCalculated) {
  const GilbertElliott slow = fitted_gilbert_elliott(0.075, Repetition::khz_5, 500'000);
  EXPECT_DOUBLE_EQ(1 / slow.to_good, 7500);
  EXPECT_DOUBLE_EQ(1 / slow.to_bad, 142'500);
  EXPECT_DOUBLE_EQ(slow.bad_flip, 7.5e-4);
  const GilbertElliott fast = fitted_gilbert_elliott(0.075, Repetition::khz_100, 500'000);
  EXPECT_DOUBLE_EQ(1 / fast.to_good, 375);
  EXPECT_DOUBLE_EQ(1 / fast.to_bad, 149'625);
  EXPECT_DOUBLE_EQ(fast.bad_flip, 1.5e-2);
  EXPECT_NEAR(slow.bit_error_rate(), 3.75e-5, 1e-12);
  EXPECT_NEAR(fast.bit_error_rate(), 3.75e-5, 1e-12);
}

// At a hundred bits a second a burst lies within one bit.
TEST(FittedGilbertElliottTest, HasProbabilitiesAtAnyBitRate) {
  for (const std::int64_t bit_rate : {1, 2, 100, 10'000}) {
    const GilbertElliott fitted = fitted_gilbert_elliott(1.9, Repetition::khz_100, bit_rate);
    for (const double p : {fitted.to_bad, fitted.to_good, fitted.good_flip, fitted.bad_flip}) {
      EXPECT_TRUE(p >= 0 && p <= 1) << p << " at " << bit_rate;
    }
    GilbertElliottProcess(fitted, kernel::Random(1));
  }
}

}  // namespace
}  // namespace fieldproof::emc
