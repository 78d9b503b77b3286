#include "emc/residual/residual_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "emc/residual/weight_distribution.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"

namespace fieldproof::emc {
namespace {

// sum A_k p^k (1 - p)^(n - k): every term is positive, nothing cancels.
double by_weights(const DualWeights& dual, double ber) {
  const std::vector<BigCount> words = code_word_counts(dual, dual.bits);
  double sum = 0;
  for (unsigned k = 1; k <= dual.bits; ++k) {
    if (words[k] == 0) continue;
    const double log =
        std::log(words[k].convert_to<double>()) + k * std::log(ber) + (dual.bits - k) * std::log1p(-ber);
    sum += std::exp(log);
  }
  return sum;
}

TEST(ResidualError, IsTheSumOverTheWeights) {
  for (const std::string_view name : {"CRC-16/IBM-3740", "CRC-16/PROFIBUS", "CRC-16/MODBUS", "CRC-15/CAN",
                                      "CRC-8/SMBUS", "CRC-21/CAN-FD"}) {
    for (const unsigned bits : {22U, 48U, 120U, 600U}) {
      const DualWeights dual = dual_weights(line::frame_check_named(name), bits);
      for (const double ber : {1e-15, 1e-9, 1e-5, 1e-3, 1e-2, 0.1, 0.49}) {
        const double expected = by_weights(dual, ber);
        EXPECT_NEAR(undetected_error_probability(dual, ber), expected, 1e-11 * expected)
            << name << bits << ber;
      }
    }
  }
}

// Printed with two digits beside the weights they are made from. [calc]
TEST(ResidualError, HasTheFirstTermOfTheTable) {
  const DualWeights dual = dual_weights(line::frame_check_named("CRC-16/IBM-3740"), 64);
  const auto first_term = [](double p) { return 84 * std::pow(p, 4) * std::pow(1 - p, 60); };
  EXPECT_NEAR(first_term(1e-3), 7.9e-11, 0.05e-11);
  EXPECT_NEAR(undetected_error_probability(dual, 1e-3), first_term(1e-3), 1e-3 * first_term(1e-3));
  EXPECT_NEAR(first_term(1e-2), 4.6e-7, 0.05e-7);
  EXPECT_GT(undetected_error_probability(dual, 1e-2), first_term(1e-2));
}

TEST(ResidualError, AtOneHalfIsThatOfNoise) {
  for (const unsigned bits : {17U, 40U, 2200U}) {
    EXPECT_DOUBLE_EQ(
        undetected_error_probability(dual_weights(line::frame_check_named("CRC-16/MODBUS"), bits), 0.5),
        0x1p-16 - std::ldexp(1.0, -static_cast<int>(bits)));
  }
}

TEST(ResidualError, IsZeroWhereNothingCanBeWrong) {
  EXPECT_EQ(undetected_error_probability(dual_weights(line::frame_check_named("CRC-16/MODBUS"), 2200), 0), 0);
  EXPECT_EQ(undetected_error_probability(dual_weights(line::frame_check_named("CRC-16/MODBUS"), 16), 0.3), 0);
  EXPECT_EQ(undetected_share_of_corrupted(dual_weights(line::frame_check_named("CRC-16/MODBUS"), 2200), 0),
            0);
}

TEST(ResidualError, RefusesRatesThatAreNone) {
  const DualWeights dual = dual_weights(line::frame_check_named("CRC-8/SMBUS"), 40);
  for (const double ber : {-0.1, 0.51, 0.9e-15, std::nan("")}) {
    EXPECT_THROW(undetected_error_probability(dual, ber), kernel::Error) << ber;
  }
}

TEST(ResidualError, ShareOfCorruptedIsConditional) {
  const DualWeights dual = dual_weights(line::frame_check_named("CRC-16/MODBUS"), 80);
  const double corrupted = 1 - std::pow(1 - 0.01, 80);
  EXPECT_NEAR(
      undetected_share_of_corrupted(dual, 0.01) * corrupted / undetected_error_probability(dual, 0.01), 1,
      1e-12);
}

// With one bit of message the generator is the only code word: p^4 (1 - p)^13 has its maximum at 4 / 17.
TEST(ResidualError, WorstRateOfASingleCodeWordIsItsShareOfOnes) {
  const WorstError worst =
      worst_undetected_error(dual_weights(line::frame_check_named("CRC-16/IBM-3740"), 17));
  EXPECT_NEAR(worst.ber, 4.0 / 17, 1e-6);
  EXPECT_NEAR(worst.probability / (std::pow(4.0 / 17, 4) * std::pow(13.0 / 17, 13)), 1, 1e-12);
  EXPECT_FALSE(worst.rises_throughout);
}

TEST(ResidualError, WorstRateIsNotTheGreatestBeyondTheOrderOfX) {
  const DualWeights dual = dual_weights(line::frame_check_named("CRC-16/PROFIBUS"), 4128);
  const WorstError worst = worst_undetected_error(dual);
  EXPECT_FALSE(worst.rises_throughout);
  EXPECT_GT(worst.probability, 2 * 0x1p-16);
  // 1369 pairs of flips are hidden; their term alone is largest at 2 / 4128.
  EXPECT_NEAR(worst.ber, 2.0 / 4128, 0.1 * 2.0 / 4128);
  for (double ber = 1e-5; ber < 0.5; ber *= 1.03) {
    EXPECT_LE(undetected_error_probability(dual, ber), worst.probability * (1 + 1e-12)) << ber;
  }
  // A limit below the maximum is the worst itself: the curve rises up to there.
  const WorstError limited = worst_undetected_error(dual, 1e-5);
  EXPECT_EQ(limited.ber, 1e-5);
  EXPECT_TRUE(limited.rises_throughout);
}

TEST(ResidualError, BoundForProperPolynomialsIsTheTailOfTheFlips) {
  // C(5, 4) p^4 (1 - p) + p^5 over 2^3.
  EXPECT_NEAR(proper_polynomial_bound(3, 5, 4, 0.1), (5 * 1e-4 * 0.9 + 1e-5) / 8, 1e-18);
  EXPECT_DOUBLE_EQ(proper_polynomial_bound(16, 100, 1, 0.5), 0x1p-16);
}

// A proper polynomial without the factor x + 1: the formula holds but for its fourth digit.
TEST(ResidualError, BoundForProperPolynomialsNearlyHoldsForOne) {
  const DualWeights proper = dual_weights(line::frame_check_named("CRC-16/PROFIBUS"), 64);
  ASSERT_TRUE(worst_undetected_error(proper).rises_throughout);
  const unsigned distance = *hamming_distance(proper);
  for (double ber = 1e-6; ber <= 0.5; ber *= 1.5) {
    EXPECT_LE(undetected_error_probability(proper, ber),
              1.001 * proper_polynomial_bound(16, 64, distance, ber))
        << ber;
  }
}

// What the formula is too good for: all hidden patterns have even weights, so there are twice as many of
// them; and a short telegram exceeds even 2^-16.
TEST(ResidualError, BoundForProperPolynomialsDoesNotHoldWithAFactorXPlusOne) {
  const DualWeights proper = dual_weights(line::frame_check_named("CRC-16/IBM-3740"), 300);
  ASSERT_TRUE(worst_undetected_error(proper).rises_throughout);
  EXPECT_NEAR(undetected_error_probability(proper, 1e-5) / proper_polynomial_bound(16, 300, 4, 1e-5), 2, 0.5);
  const WorstError improper =
      worst_undetected_error(dual_weights(line::frame_check_named("CRC-16/IBM-3740"), 48));
  EXPECT_FALSE(improper.rises_throughout);
  EXPECT_GT(improper.probability, 3 * 0x1p-16);
}

TEST(ResidualError, RatePerHourCountsMessagesAndReceivers) {
  EXPECT_DOUBLE_EQ(residual_error_rate_per_hour(1e-12, 36'000, 4), 1.44e-7);
}

// The definition: at the bound, so few errors have the probability 5 %.
TEST(ResidualError, BoundOfAShareIsWhereSoFewErrorsAreFivePercent) {
  EXPECT_NEAR(upper_bound_of_share(0, 1000), 1 - std::pow(0.05, 1e-3), 1e-12);
  for (const unsigned wrong : {0U, 1U, 3U, 7U, 19U}) {
    constexpr unsigned kTotal = 20;
    const double bound = upper_bound_of_share(wrong, kTotal);
    double so_few = 0;
    double ways = 1;
    for (unsigned k = 0; k <= wrong; ++k) {
      so_few += ways * std::pow(bound, k) * std::pow(1 - bound, kTotal - k);
      ways = ways * (kTotal - k) / (k + 1);
    }
    EXPECT_NEAR(so_few, 0.05, 1e-9) << wrong;
  }
  EXPECT_EQ(upper_bound_of_share(20, 20), 1);
  EXPECT_EQ(upper_bound_of_share(0, 0), 1);
  EXPECT_NEAR(upper_bound_of_share(0, 10'000'000), 2.9957e-7, 1e-11);
}

// 10^4 campaigns in which each of so many exchanges passes with a known probability: the bound holds in 95 %
// of them. Four times as many exchanges, of which most could not pass at all, would make it false.
TEST(ResidualError, BoundOfAShareHoldsInNineteenOfTwentyCampaigns) {
  constexpr int kCampaigns = 10'000;
  constexpr double kScatter = 3 * 0.0022;  // three standard deviations of a share of 0.95
  kernel::Random random(27);
  for (const unsigned exchanges : {20U, 300U, 2'000U}) {
    for (const double truth : {0.002, 0.02, 0.15}) {
      int holds = 0;
      int holds_of_all = 0;
      for (int n = 0; n < kCampaigns; ++n) {
        std::uint64_t wrong = 0;
        for (std::uint64_t at = random.geometric(truth); at < exchanges; at += 1 + random.geometric(truth))
          ++wrong;
        holds += upper_bound_of_share(wrong, exchanges) >= truth ? 1 : 0;
        holds_of_all += upper_bound_of_share(wrong, std::uint64_t{4} * exchanges) >= truth ? 1 : 0;
      }
      EXPECT_GE(holds, kCampaigns * (0.95 - kScatter)) << exchanges << " " << truth;
      if (exchanges * truth < 5) continue;
      EXPECT_LT(holds_of_all, kCampaigns / 10) << exchanges << " " << truth;
    }
  }
}

}  // namespace
}  // namespace fieldproof::emc
