#include "emc/threshold_search.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

namespace fieldproof::emc {
namespace {

Probe steps_at(double b, double c, double d) {
  return [=](double volts) {
    if (volts >= d) return Criterion::d;
    if (volts >= c) return Criterion::c;
    return volts >= b ? Criterion::b : Criterion::a;
  };
}

TEST(ThresholdSearch, FindsWhereACriterionBegins) {
  const Thresholds found = find_thresholds(40.5, 4000, steps_at(60, 100, 1e9));
  EXPECT_NEAR(found.a_up_to_volts, 59, 3);
  EXPECT_NEAR(*found.seen_from[1], 60, 3);
  EXPECT_NEAR(*found.seen_from[2], 100, 5);
  EXPECT_FALSE(found.seen_from[3].has_value());
  EXPECT_LT(found.a_up_to_volts, *found.seen_from[1]);
  EXPECT_LE(found.probes.size(), 20U);
  EXPECT_EQ(text_of(find_thresholds(40.5, 4000, steps_at(41, 1e9, 1e9))),
            "A up to 40 V, B from 42 V, C and D not seen up to 4000 V");
}

TEST(ThresholdSearch, SaysWhereNothingComesAndWhereAllComesAtOnce) {
  EXPECT_EQ(text_of(find_thresholds(100, 4000, steps_at(1e9, 1e9, 1e9))),
            "A up to 4000 V, B and C and D not seen up to 4000 V");
  EXPECT_EQ(text_of(find_thresholds(5000, 4000, steps_at(1, 1, 1))),
            "A up to 4000 V, B and C and D not seen up to 4000 V")
      << "below the threshold nothing is probed";
  EXPECT_EQ(text_of(find_thresholds(50, 4000, steps_at(1, 1, 1))), "A up to 49 V, D seen from 51 V");
}

TEST(ThresholdSearch, LongerTestsThatShowMoreBringItDown) {
  Thresholds found = find_thresholds(40.5, 4000, steps_at(300, 1e9, 1e9));
  take(found, 1000, Criterion::a);
  EXPECT_NEAR(*found.seen_from[1], 300, 15);
  take(found, 250, Criterion::c);
  EXPECT_EQ(*found.seen_from[1], 250);
  EXPECT_EQ(*found.seen_from[2], 250);
  EXPECT_FALSE(found.seen_from[3].has_value());
  EXPECT_LT(found.a_up_to_volts, 250);
  EXPECT_GE(found.a_up_to_volts, 40);
}

TEST(ThresholdSearch, OneThatIsStoppedSaysSo) {
  int left = 3;
  const Thresholds found = find_thresholds(
      50, 4000, [&](double) { return left-- > 0 ? std::optional(Criterion::a) : std::nullopt; });
  EXPECT_FALSE(found.is_complete);
  EXPECT_EQ(found.probes.size(), 3U);
}

RC_GTEST_PROP(ThresholdSearchProperty, EndsAndIsWithinFivePercentOfEachStep, ()) {
  const double from = *rc::gen::inRange(0, 3000);
  std::vector<double> steps = *rc::gen::container<std::vector<double>>(
      3, rc::gen::map(rc::gen::inRange(1, 6000), [](int v) { return v + 0.0; }));
  std::ranges::sort(steps);
  for (double& step : steps) step = std::max(step, std::max(from, 1.0));
  const Thresholds found = find_thresholds(from, 4000, steps_at(steps[0], steps[1], steps[2]));
  RC_ASSERT(found.is_complete);
  RC_ASSERT(found.probes.size() <= kMostProbes);
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const auto& seen = found.seen_from[n + 1];
    RC_ASSERT(seen.has_value() == (steps[n] <= 4000));
    if (!seen) continue;
    RC_ASSERT(*seen >= steps[n]);
    RC_ASSERT(*seen <= std::max(steps[n] * 1.06, steps[n] + 1.5));
  }
}

}  // namespace
}  // namespace fieldproof::emc
