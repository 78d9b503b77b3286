#include "harness/kernel/random.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

#include "harness/kernel/check.hpp"

namespace fieldproof::kernel {
namespace {

// Probability of a deviation at least this large if all cells are as likely as expected.
double p_value(const std::vector<double>& expected, const std::vector<std::uint64_t>& counted) {
  double sum = 0;
  for (std::size_t cell = 0; cell < counted.size(); ++cell) {
    const double difference = static_cast<double>(counted[cell]) - expected[cell];
    sum += difference * difference / expected[cell];
  }
  const boost::math::chi_squared distribution(static_cast<double>(counted.size() - 1));
  return boost::math::cdf(boost::math::complement(distribution, sum));
}

// The seeds are fixed, so these cannot fail by chance from one run to the next; below this the generator or
// the transformation is wrong.
constexpr double kSuspicious = 1e-4;

constexpr std::uint64_t kPinnedSum = 4647587892399908609;
constexpr std::uint64_t kPinnedSkips = 8728129619465486694;

double uniformity(std::size_t cells, std::size_t draws, const std::function<std::uint64_t()>& draw) {
  std::vector<std::uint64_t> counted(cells);
  for (std::size_t k = 0; k < draws; ++k) ++counted.at(draw());
  return p_value(std::vector<double>(cells, static_cast<double>(draws) / static_cast<double>(cells)),
                 counted);
}

// First outputs of xoshiro256** with its state filled by SplitMix64 from 0, as other implementations print
// them.
TEST(Random, GivesThePublishedSequenceOfSeedZero) {
  Random random(0);
  EXPECT_EQ(random.next(), 11091344671253066420U);
  EXPECT_EQ(random.next(), 13793997310169335082U);
  EXPECT_EQ(random.next(), 1900383378846508768U);
  EXPECT_EQ(random.next(), 7684712102626143532U);
  EXPECT_EQ(random.next(), 13521403990117723737U);
}

TEST(Random, BelowIsUniform) {
  for (const std::uint64_t bound : {2U, 3U, 10U, 1000U}) {
    Random random(bound);
    EXPECT_GT(uniformity(bound, 200'000, [&] { return random.below(bound); }), kSuspicious) << bound;
  }
}

// A bound of three quarters of the range is where a modulus or a bare multiplication is visibly unfair.
TEST(Random, BelowIsUniformForHugeBounds) {
  Random random(5);
  constexpr std::uint64_t kQuarter = std::uint64_t{1} << 62;
  EXPECT_GT(uniformity(3, 200'000, [&] { return random.below(3 * kQuarter) / kQuarter; }), kSuspicious);
  EXPECT_GT(uniformity(3, 200'000, [&] { return random.below(3 * kQuarter) % 3; }), kSuspicious);
}

TEST(Random, BetweenReachesBothEndsAndTheWholeRange) {
  Random random(6);
  std::set<std::int64_t> seen;
  for (int k = 0; k < 1000; ++k) seen.insert(random.between(-2, 3));
  EXPECT_EQ(seen, (std::set<std::int64_t>{-2, -1, 0, 1, 2, 3}));
  EXPECT_EQ(random.between(7, 7), 7);
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  bool negative = false;
  bool positive = false;
  for (int k = 0; k < 100; ++k) (random.between(kMin, kMax) < 0 ? negative : positive) = true;
  EXPECT_TRUE(negative && positive);
}

TEST(Random, UniformFillsTheUnitInterval) {
  Random random(7);
  EXPECT_GT(uniformity(1000, 1'000'000, [&] { return static_cast<std::uint64_t>(random.uniform() * 1000); }),
            kSuspicious);
}

TEST(Random, ChanceIsAsLikelyAsAsked) {
  Random random(8);
  EXPECT_GT(uniformity(4, 100'000, [&] { return random.chance(0.25) ? 0U : 1 + random.below(3); }),
            kSuspicious);
  for (int k = 0; k < 1000; ++k) {
    EXPECT_FALSE(random.chance(0));
    EXPECT_TRUE(random.chance(1));
  }
}

TEST(Random, GeometricHasTheRightDistribution) {
  for (const double p : {0.9, 0.5, 0.2, 0.03}) {
    Random random(9);
    constexpr std::size_t kCells = 20;
    constexpr double kDraws = 200'000;
    std::vector<std::uint64_t> counted(kCells + 1);
    for (int k = 0; k < static_cast<int>(kDraws); ++k)
      ++counted[std::min<std::uint64_t>(random.geometric(p), kCells)];
    std::vector<double> expected;
    for (std::size_t k = 0; k < kCells; ++k) expected.push_back(kDraws * p * std::pow(1 - p, k));
    expected.push_back(kDraws * std::pow(1 - p, kCells));
    // Cells too rare for the approximation are joined to the last that is not.
    while (expected.back() < 5) {
      expected[expected.size() - 2] += expected.back();
      counted[counted.size() - 2] += counted.back();
      expected.pop_back();
      counted.pop_back();
    }
    EXPECT_GT(p_value(expected, counted), kSuspicious) << p;
  }
}

TEST(Random, RareGeometricHitsHaveTheRightQuantiles) {
  constexpr double kChance = 1e-7;
  const GeometricSkip skip(kChance);
  Random random(10);
  // 1 - (1 - p)^k = q at k = ln(1 - q) / ln(1 - p): ten cells of equal probability.
  EXPECT_GT(uniformity(10, 100'000,
                       [&] {
                         const auto k = static_cast<double>(skip(random));
                         return std::min<std::uint64_t>(
                             9, static_cast<std::uint64_t>(-std::expm1(k * std::log1p(-kChance)) * 10));
                       }),
            kSuspicious);
}

// The quick logarithm of a skip against the exact one, draw by draw. A skip of 10^12 shows the twelfth digit.
TEST(Random, GeometricIsTheInversionOfItsDraw) {
  for (const double p : {0.3, 1e-3, 1e-12}) {
    const GeometricSkip skip(p);
    Random random(12);
    Random same(12);
    for (int k = 0; k < 100'000; ++k) {
      const double uniform = static_cast<double>((same.next() >> 11) + 1) * 0x1p-53;
      const double exact = portable_log(uniform) / portable_log_of_complement(p);
      const auto drawn = static_cast<double>(skip(random));
      ASSERT_LE(drawn, exact * (1 + 1e-15) + 4e-16 / p) << uniform;
      ASSERT_GT(drawn, exact * (1 - 1e-15) - 4e-16 / p - 1) << uniform;
    }
  }
}

TEST(Random, GeometricOfSureAndImpossibleHits) {
  constexpr std::uint64_t kForever = std::numeric_limits<std::uint64_t>::max();
  Random random(11);
  for (int k = 0; k < 1000; ++k) {
    EXPECT_EQ(random.geometric(1), 0U);
    EXPECT_EQ(random.geometric(0), kForever);
    EXPECT_EQ(random.geometric(-0.5), kForever);
  }
  EXPECT_THROW(random.geometric(std::nan("")), BrokenInvariant);
}

TEST(Random, PortableLogarithmsAgreeWithTheLibrary) {
  Random random(12);
  for (int k = 0; k < 100'000; ++k) {
    const double u = (static_cast<double>(random.next() >> 11) + 1) * 0x1p-53;
    const double x = u * std::exp2(static_cast<double>(random.between(-60, 60)));
    const double p = u * std::exp2(static_cast<double>(random.between(-60, 0))) * 0.999;
    EXPECT_NEAR(portable_log(x), std::log(x), std::abs(std::log(x)) * 1e-15 + 1e-16) << x;
    EXPECT_NEAR(portable_log_of_complement(p), std::log1p(-p), std::abs(std::log1p(-p)) * 2e-15) << p;
  }
  EXPECT_EQ(portable_log(1), 0);
}

// Pinned, so that a change of compiler, library or processor that shifts a bit is seen.
TEST(Random, DerivedDrawsAreTheSameEverywhere) {
  Random random(2024);
  double sum = 0;
  std::uint64_t skips = 0;
  for (int k = 0; k < 1000; ++k) {
    sum += random.uniform();
    skips = skips * 31 + random.geometric(1e-5) + random.below(1000);
  }
  EXPECT_EQ(std::bit_cast<std::uint64_t>(sum), kPinnedSum);
  EXPECT_EQ(skips, kPinnedSkips);
}

RC_GTEST_PROP(Random, SplitDependsOnTheSeedAndTheNameOnly,
              (std::uint64_t seed, std::uint8_t drawn, std::string label, std::uint64_t index)) {
  const Random fresh(seed);
  Random used(seed);
  for (unsigned k = 0; k < drawn; ++k) used.next();
  RC_ASSERT(fresh.split(label).next() == used.split(label).next());
  RC_ASSERT(fresh.split(index).next() == used.split(index).next());
  RC_ASSERT(fresh.split(index).next() == RandomChildren(used)[index].next());
  RC_ASSERT(fresh.split(label).seed() != seed);
  RC_ASSERT(fresh.split(index).seed() != fresh.split(index + 1).seed());
  RC_ASSERT(fresh.split(label).seed() != fresh.split(label + "x").seed());
  RC_ASSERT(fresh.split(index).seed() != Random(seed + 1).split(index).seed());
}

TEST(Random, ChildrenDifferFromEachOtherAndFromTheirParents) {
  std::set<std::uint64_t> seeds;
  std::size_t made = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Random parent(seed);
    for (std::uint64_t child = 0; child < 100; ++child) {
      seeds.insert(parent.split(child).seed());
      seeds.insert(parent.split(std::to_string(child)).seed());
      seeds.insert(parent.split(child).split(0).seed());
      made += 3;
    }
  }
  EXPECT_EQ(seeds.size(), made);
}

// The exclusive or of two neighbouring children is uniform too: neither copies the other.
TEST(Random, NeighbouringChildrenAreIndependent) {
  const Random parent(13);
  std::uint64_t child = 0;
  EXPECT_GT(uniformity(256, 200'000,
                       [&] {
                         Random a = parent.split(child);
                         Random b = parent.split(++child);
                         return (a.next() ^ b.next()) >> 56;
                       }),
            kSuspicious);
}

TEST(Random, ShuffleGivesEveryOrderEquallyOften) {
  Random random(14);
  EXPECT_GT(uniformity(24, 240'000,
                       [&] {
                         std::array<unsigned, 4> order = {0, 1, 2, 3};
                         random.shuffle(order);
                         std::uint64_t rank = 0;
                         for (std::size_t i = 0; i < 4; ++i) {
                           std::uint64_t smaller = 0;
                           for (std::size_t j = i + 1; j < 4; ++j) smaller += order[j] < order[i] ? 1U : 0U;
                           rank = rank * (4 - i) + smaller;
                         }
                         return rank;
                       }),
            kSuspicious);
  std::vector<int> none;
  random.shuffle(none);
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace fieldproof::kernel
