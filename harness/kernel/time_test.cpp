#include "harness/kernel/time.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace fieldproof::kernel {
namespace {

__extension__ using Wide = __int128;

TEST(Time, LevelsOfTheBusRates) {
  EXPECT_EQ(levels_duration(13, 500'000), 26 * kMicrosecond);
  EXPECT_EQ(levels_duration(1, 31'250), 32 * kMicrosecond);
  EXPECT_EQ(levels_duration(0, 500'000), Duration::zero());
  // 1 / 187500 s = 5 333 333.33 ps: rounded once, so three levels are exact again.
  EXPECT_EQ(levels_duration(1, 187'500).count(), 5'333'333);
  EXPECT_EQ(levels_duration(2, 187'500).count(), 10'666'667);
  EXPECT_EQ(levels_duration(3, 187'500).count(), 16'000'000);
  EXPECT_EQ(levels_duration(-2, 187'500).count(), -10'666'667);
}

TEST(Time, RoundsHalvesAwayFromZero) {
  // 2 * 10^12 levels a second: half a picosecond each, also above the rates of 64-bit arithmetic.
  EXPECT_EQ(levels_duration(1, 2'000'000'000'000).count(), 1);
  EXPECT_EQ(levels_duration(3, 2'000'000'000'000).count(), 2);
  EXPECT_EQ(levels_duration(-1, 2'000'000'000'000).count(), -1);
}

TEST(Time, SaturatesInsteadOfWrapping) {
  constexpr std::int64_t kMany = std::int64_t{1} << 40;
  EXPECT_EQ(levels_duration(kMany, 1), Duration::max());
  EXPECT_EQ(levels_duration(-kMany, 1), -Duration::max());
  EXPECT_EQ(level_time(kNever, 1, 1), kNever);
  EXPECT_EQ(level_time(Time{-Duration::max()}, -1, 1), Time{-Duration::max()});
  EXPECT_EQ(levels_duration(std::numeric_limits<std::int64_t>::min(), 1), -Duration::max());
  // The last second that fits, and its last picosecond.
  EXPECT_EQ(levels_duration(9'223'372, 1).count(), 9'223'372'000'000'000'000);
  EXPECT_EQ(levels_duration(9'223'373, 1), Duration::max());
}

RC_GTEST_PROP(Time, IsTheExactQuotientRoundedOnce, ()) {
  const auto rate = *rc::gen::oneOf(rc::gen::inRange<std::int64_t>(1, 1000),
                                    rc::gen::inRange<std::int64_t>(1000, 2'000'000),
                                    rc::gen::inRange<std::int64_t>(15'999'990, 16'000'010),
                                    rc::gen::inRange<std::int64_t>(16'000'000, 2'000'000'000),
                                    rc::gen::inRange<std::int64_t>(9'223'372'036'844, 9'223'372'036'864));
  const auto n =
      *rc::gen::oneOf(rc::gen::inRange<std::int64_t>(-100'000, 100'000),
                      rc::gen::inRange<std::int64_t>(-(std::int64_t{1} << 40), (std::int64_t{1} << 40) + 1));
  const Wide exact = Wide{n} * 1'000'000'000'000;
  const Wide got = levels_duration(n, rate).count();
  if (exact / rate > std::numeric_limits<std::int64_t>::max() - 1 ||
      exact / rate < -std::numeric_limits<std::int64_t>::max() + 1) {
    RC_ASSERT(got == (n < 0 ? -Wide{Duration::max().count()} : Wide{Duration::max().count()}));
    return;
  }
  // |got * rate - exact| <= rate / 2, halves away from zero.
  const Wide error = 2 * (got * rate - exact) * (n < 0 ? -1 : 1);
  RC_ASSERT(error > -rate);
  RC_ASSERT(error <= rate);
  RC_ASSERT(level_time(kStart + Duration{17}, n, rate) == Time{Duration{17}} + levels_duration(n, rate) ||
            levels_duration(n, rate).count() > std::numeric_limits<std::int64_t>::max() - 17);
}

RC_GTEST_PROP(Time, CountsTheLevelsThatFit, ()) {
  const auto rate = *rc::gen::oneOf(rc::gen::inRange<std::int64_t>(1, 2'000'000),
                                    rc::gen::inRange<std::int64_t>(1, 2'000'000'000));
  const auto duration = *rc::gen::oneOf(rc::gen::inRange<std::int64_t>(0, 1'000'000'000),
                                        rc::gen::inRange<std::int64_t>(0, 1'000'000'000'000'000));
  RC_ASSERT(levels_within(Duration{duration}, rate) == Wide{duration} * rate / 1'000'000'000'000);
}

TEST(Time, IsDescribedExactlyInSensibleUnits) {
  EXPECT_EQ(describe(Duration{814'800'000}), "814.800 us");
  EXPECT_EQ(describe(Duration{1'000'000'500}), "1.000000500 ms");
  EXPECT_EQ(describe(Duration{750}), "750 ps");
  EXPECT_EQ(describe(Duration{0}), "0 s");
  EXPECT_EQ(describe(25 * kMillisecond), "25.000 ms");
  EXPECT_EQ(describe(Duration{1'001}), "1.001 ns");
  EXPECT_EQ(describe(90 * kSecond + Duration{1}), "90.000000000001 s");
  EXPECT_EQ(describe(-3 * kMicrosecond), "-3.000 us");
  EXPECT_EQ(describe(Duration::min()), "-9223372.036854775808 s");
  EXPECT_EQ(describe(kNever), "never");
  EXPECT_EQ(describe(kStart + 2 * kMicrosecond), "2.000 us");
}

}  // namespace
}  // namespace fieldproof::kernel
