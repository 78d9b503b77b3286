#include "harness/measure/time_course.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kMillisecond;
using kernel::kSecond;
using kernel::kStart;
using kernel::Time;

TEST(TimeCourseTest, AWindowHasItsValuesByPhase) {
  TimeCourse course(10 * kSecond, 10);
  course.add(Duration{0}, Phase::quiet, 4);
  course.add(kSecond - Duration{1}, Phase::quiet, 8);
  course.add(kSecond - Duration{1}, Phase::burst, 20);
  course.add(kSecond, Phase::quiet, 5);
  const auto points = course.points();
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(course.window(), kSecond);
  EXPECT_EQ(points[0].from, Duration{0});
  EXPECT_EQ(points[0].phase, Phase::quiet);
  EXPECT_EQ(points[0].count, 2U);
  EXPECT_EQ(points[0].min, 4);
  EXPECT_EQ(points[0].max, 8);
  EXPECT_EQ(points[0].mean, 6.0);
  EXPECT_EQ(points[1].phase, Phase::burst);
  EXPECT_EQ(points[1].max, 20);
  EXPECT_EQ(points[2].from, kSecond);
  EXPECT_EQ(points[2].mean, 5.0);
}

TEST(TimeCourseTest, WhatLiesOutsideCountsToTheNearestWindow) {
  TimeCourse course(10 * kSecond, 10);
  course.add(-3 * kSecond, Phase::quiet, 1);
  course.add(10 * kSecond, Phase::quiet, 2);
  course.add(99 * kSecond, Phase::quiet, 3);
  const auto points = course.points();
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].from, Duration{0});
  EXPECT_EQ(points[1].from, 9 * kSecond);
  EXPECT_EQ(points[1].count, 2U);
}

TEST(TimeCourseTest, TheLongestHaveTheirInstants) {
  TimeCourse course(kSecond, 3);
  for (std::int64_t n = 0; n < 100; ++n) course.add(n * kMillisecond, Phase::quiet, n % 10);
  course.add(500 * kMillisecond, Phase::recovery, 70);
  course.add(501 * kMillisecond, Phase::burst, 90);
  const auto& longest = course.longest();
  ASSERT_EQ(longest.size(), TimeCourse::kMostLongest);
  EXPECT_EQ(longest[0].value, 90);
  EXPECT_EQ(longest[0].phase, Phase::burst);
  EXPECT_EQ(longest[1].when, 500 * kMillisecond);
  // Of equals the earlier.
  EXPECT_EQ(longest[2].value, 9);
  EXPECT_EQ(longest[2].when, 9 * kMillisecond);
  EXPECT_EQ(longest[4].when, 29 * kMillisecond);
}

TEST(TimeCourseTest, ARunThatDoesNotLastIsNone) {
  EXPECT_THROW(TimeCourse(Duration{0}, 10), kernel::BrokenInvariant);
  EXPECT_THROW(TimeCourse(kSecond, 0), kernel::BrokenInvariant);
}

// However long a run lasts and whatever comes, the windows are bounded, hold every value, and have the
// extremes.
RC_GTEST_PROP(TimeCourseTest, WindowsAreBoundedAndLoseNothing, ()) {
  const auto length = Duration{*rc::gen::inRange<std::int64_t>(1, 360'000 * kSecond.count())};
  const auto most = *rc::gen::inRange<std::size_t>(1, 1000);
  TimeCourse course(length, most);
  const auto values = *rc::gen::nonEmpty<std::vector<int>>();
  std::int64_t until = 0;
  for (const int value : values) {
    until += length.count() / static_cast<std::int64_t>(values.size());
    course.add(Duration{until}, Phase::quiet, value);
  }
  std::uint64_t count = 0;
  std::int64_t max = course.points().front().max;
  for (const auto& point : course.points()) {
    RC_ASSERT(point.from >= Duration{0} && point.from < length);
    RC_ASSERT(point.from.count() % course.window().count() == 0);
    RC_ASSERT(static_cast<double>(point.min) <= point.mean + 1e-6 &&
              point.mean <= static_cast<double>(point.max) + 1e-6);
    count += point.count;
    max = std::max(max, point.max);
  }
  RC_ASSERT(course.points().size() <= most);
  RC_ASSERT(count == values.size());
  RC_ASSERT(max == *std::ranges::max_element(values));
  RC_ASSERT(course.longest().front().value == max);
}

// One of `lasts` every `period`, from `first` on.
NextDisturbance every(Duration period, Duration first, Duration lasts) {
  return [=](Time after) -> std::optional<Span> {
    Time from = kStart + first;
    while (from + lasts <= after) from += period;
    return Span{from, from + lasts};
  };
}

TEST(BandsTest, AreCutAtTheEndsOfTheRun) {
  const auto next = every(300 * kMillisecond, 0 * kMillisecond, 15 * kMillisecond);
  const auto bands = bands_between(next, kStart + 5 * kMillisecond, 600 * kMillisecond, 10 * kMillisecond);
  ASSERT_EQ(bands.size(), 3U);
  EXPECT_EQ(bands[0].from, Duration{0});
  EXPECT_EQ(bands[0].to, 10 * kMillisecond);
  EXPECT_EQ(bands[1].from, 295 * kMillisecond);
  EXPECT_EQ(bands[2].from, 595 * kMillisecond);
  EXPECT_EQ(bands[2].to, 600 * kMillisecond);
}

TEST(BandsTest, ThoseThatAreTooNearAreOne) {
  const auto next = every(300 * kMillisecond, 20 * kMillisecond, 15 * kMillisecond);
  const auto bands = bands_between(next, kStart, 10 * kSecond, 286 * kMillisecond);
  ASSERT_EQ(bands.size(), 1U);
  EXPECT_EQ(bands[0].disturbances, 34U);
  EXPECT_EQ(bands[0].from, 20 * kMillisecond);
  EXPECT_EQ(bands[0].to, 9'935 * kMillisecond);
  EXPECT_EQ(bands_between(next, kStart, 10 * kSecond, 285 * kMillisecond).size(), 34U);
}

TEST(BandsTest, WithoutADisturbanceThereAreNone) {
  EXPECT_TRUE(bands_between(nullptr, kStart, kSecond, kMillisecond).empty());
  EXPECT_TRUE(
      bands_between([](Time) { return std::optional<Span>{}; }, kStart, kSecond, kMillisecond).empty());
  EXPECT_TRUE(
      bands_between(every(kSecond, 2 * kSecond, kMicrosecond), kStart, kSecond, kMillisecond).empty());
}

}  // namespace
}  // namespace fieldproof::measure
