#include "harness/measure/distribution.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "harness/kernel/random.hpp"

namespace fieldproof::measure {
namespace {

Distribution of(const std::vector<std::int64_t>& values, std::size_t most_exact = Distribution::kMostExact) {
  Distribution made(most_exact);
  for (const std::int64_t value : values) made.add(value);
  return made;
}

std::vector<std::int64_t> one_to(std::int64_t last) {
  std::vector<std::int64_t> values(static_cast<std::size_t>(last));
  std::iota(values.begin(), values.end(), 1);
  return values;
}

TEST(DistributionTest, NothingIsZeroEverywhere) {
  const Distribution empty;
  EXPECT_TRUE(empty.is_empty());
  EXPECT_EQ(empty.quantile(0.5), 0);
  EXPECT_EQ(empty.mean(), 0);
  EXPECT_EQ(empty.standard_deviation(), 0);
  EXPECT_TRUE(empty.histogram(10).empty());
}

TEST(DistributionTest, QuantilesAreByNearestRank) {
  const Distribution hundred = of(one_to(100));
  EXPECT_EQ(hundred.quantile(0), 1);
  EXPECT_EQ(hundred.quantile(0.01), 1);
  EXPECT_EQ(hundred.quantile(0.010001), 2);
  EXPECT_EQ(hundred.quantile(0.5), 50);
  EXPECT_EQ(hundred.quantile(0.99), 99);
  EXPECT_EQ(hundred.quantile(0.9999), 100);
  EXPECT_EQ(hundred.quantile(1), 100);
  EXPECT_EQ(of({7}).quantile(0.99), 7);
}

TEST(DistributionTest, MomentsAreThoseOfThePopulation) {
  const Distribution dice = of({1, 2, 3, 4, 5, 6});
  EXPECT_DOUBLE_EQ(dice.mean(), 3.5);
  EXPECT_DOUBLE_EQ(dice.standard_deviation(), std::sqrt(35.0 / 12));
  EXPECT_EQ(of({5, 5, 5}).standard_deviation(), 0);
}

// Values around 10^15 that differ by one: the textbook form of the variance loses them all.
TEST(DistributionTest, DeviationOfLargeValuesIsNotLost) {
  const std::int64_t far = 1'000'000'000'000'000;
  EXPECT_NEAR(of({far, far + 1, far, far + 1}).standard_deviation(), 0.5, 1e-9);
}

TEST(DistributionTest, BothSidesOfTheExactLimit) {
  Distribution few(4);
  for (const std::int64_t value : {10, 20, 30, 40}) few.add(value);
  EXPECT_TRUE(few.has_exact_quantiles());
  few.add(1'000'000);
  EXPECT_FALSE(few.has_exact_quantiles());
  EXPECT_EQ(few.count(), 5U);
  EXPECT_EQ(few.quantile(0.5), 30);       // below 2048 each value has its own bucket
  EXPECT_EQ(few.quantile(1), 1'000'000);  // never beyond the extremes, which are exact
  EXPECT_EQ(few.max(), 1'000'000);
}

TEST(DistributionTest, HistogramHoldsEveryValueOnce) {
  const Distribution hundred = of(one_to(100));
  const auto bins = hundred.histogram(10);
  ASSERT_EQ(bins.size(), 10U);
  for (const auto& bin : bins) EXPECT_EQ(bin.count, 10U);
  EXPECT_EQ(bins.front().low, 1);
  EXPECT_EQ(bins.front().high, 11);
  EXPECT_EQ(bins.back().high, 100);
  const auto one = of({3, 3}).histogram(10);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one.front().count, 2U);
}

TEST(DistributionTest, TheWholeRangeOfNumbersFits) {
  constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  const Distribution all = of({least, 0, most}, 1);
  EXPECT_EQ(all.min(), least);
  EXPECT_EQ(all.quantile(0.5), 0);
  EXPECT_EQ(all.quantile(1), most);
  std::uint64_t sum = 0;
  for (const auto& bin : all.histogram(7)) sum += bin.count;
  EXPECT_EQ(sum, 3U);
}

// Against a sorted list: with buckets every quantile is within the stated error, signs and order included.
RC_GTEST_PROP(DistributionTest, BucketsAreWithinTheStatedError, ()) {
  auto values = *rc::gen::nonEmpty(rc::gen::container<std::vector<std::int64_t>>(rc::gen::map(
      rc::gen::pair(rc::gen::inRange<std::int64_t>(-(1LL << 40), 1LL << 40), rc::gen::inRange(0, 40)),
      [](const auto& drawn) { return drawn.first >> drawn.second; })));
  const Distribution bucketed = of(values, 0);
  const Distribution exact = of(values);
  std::sort(values.begin(), values.end());
  for (const double part : {0.0, 0.25, 0.5, 0.99, 1.0}) {
    const auto rank = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::ceil(part * static_cast<double>(values.size()))));
    const std::int64_t right = values[rank - 1];
    RC_ASSERT(exact.quantile(part) == right);
    const double error = std::abs(static_cast<double>(bucketed.quantile(part) - right));
    RC_ASSERT(error <= Distribution::kRelativeError * std::abs(static_cast<double>(right)));
  }
  RC_ASSERT(bucketed.min() == values.front());
  RC_ASSERT(bucketed.max() == values.back());
}

RC_GTEST_PROP(DistributionTest, ASumOfTwoIsThatOfAllValues,
              (const std::vector<std::int32_t>& first, const std::vector<std::int32_t>& second)) {
  const auto most_exact = *rc::gen::element<std::size_t>(0, 3, 1000);
  Distribution sum(most_exact);
  Distribution added(most_exact);
  Distribution together(most_exact);
  for (const std::int32_t value : first) sum.add(std::int64_t{value});
  for (const std::int32_t value : second) added.add(std::int64_t{value});
  for (const auto* part : {&first, &second}) {
    for (const std::int32_t value : *part) together.add(std::int64_t{value});
  }
  sum.add(added);
  RC_ASSERT(sum.count() == together.count());
  RC_ASSERT(sum.min() == together.min());
  RC_ASSERT(sum.max() == together.max());
  RC_ASSERT(std::abs(sum.mean() - together.mean()) <= 1e-6 * (1 + std::abs(together.mean())));
  RC_ASSERT(std::abs(sum.standard_deviation() - together.standard_deviation()) <=
            1e-6 * (1 + together.standard_deviation()));
  for (const double part : {0.0, 0.5, 1.0}) RC_ASSERT(sum.quantile(part) == together.quantile(part));
}

}  // namespace
}  // namespace fieldproof::measure
