#include "reports/trend.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fieldproof::reports {
namespace {

TEST(Trend, FiveValuesThatRiseAreTwoOfAllOrders) {
  const std::vector<double> values = {1, 2, 3, 4, 5};
  EXPECT_NEAR(trend_of(values).probability, 2.0 / 120, 1e-12);
  EXPECT_DOUBLE_EQ(trend_of(values).slope, 1);
}

TEST(Trend, FewValuesAndEqualOnesShowNothing) {
  const std::vector<double> few = {1, 2, 3, 4};
  EXPECT_FALSE(trend_of(few).is_tested());
  EXPECT_EQ(trend_of(few).probability, 1);
  const std::vector<double> equal(50, 814.0);
  EXPECT_EQ(trend_of(equal).probability, 1);
  EXPECT_EQ(trend_of(equal).slope, 0);
}

// S is 25 of 45 pairs, and its variance (10*9*25 - 2*5*4*15) / 18.
TEST(Trend, AStepIsADriftWithTiesAllowedFor) {
  const std::vector<double> values = {1, 1, 1, 1, 1, 2, 2, 2, 2, 2};
  const double deviations = 24 / std::sqrt(1650.0 / 18);
  EXPECT_NEAR(trend_of(values).probability, std::erfc(deviations / std::sqrt(2.0)), 1e-12);
}

TEST(Trend, OneWildValueNeitherMakesNorHidesADrift) {
  std::vector<double> flat = {5, 3, 6, 4, 5.5, 3.5, 4.5, 6.5};
  flat[6] = 1e6;
  EXPECT_GT(trend_of(flat).probability, 0.05);
  std::vector<double> rising = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  rising[4] = -1e6;
  EXPECT_LT(trend_of(rising).probability, 0.05);
  EXPECT_NEAR(trend_of(rising).slope, 1, 0.01);
}

// What the approximation says of many values without ties is what the count of orders says.
TEST(Trend, TheApproximationFollowsTheExactCount) {
  std::vector<double> values;
  for (int n = 0; n < 31; ++n) values.push_back(n % 2 == 0 ? n : -n * 0.4);
  const double approximate = trend_of(values).probability;
  const double exact = trend_of(std::span(values).first(30)).probability;
  EXPECT_NEAR(approximate, exact, 0.1);
}

// Turned around, the same drift goes the other way.
RC_GTEST_PROP(Trend, TurnsWithItsValues, (const std::vector<int>& numbers)) {
  std::vector<double> values(numbers.begin(), numbers.end());
  const Trend forth = trend_of(values);
  std::ranges::reverse(values);
  const Trend back = trend_of(values);
  RC_ASSERT(forth.probability == back.probability);
  RC_ASSERT(forth.probability > 0 && forth.probability <= 1);
  RC_ASSERT(std::abs(forth.slope + back.slope) <= 1e-9 * std::abs(forth.slope));
}

}  // namespace
}  // namespace fieldproof::reports
