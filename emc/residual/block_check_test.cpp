#include "emc/residual/block_check.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "emc/residual/residual_error.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

// (sum over even k of C(N, k) x^k)^8: each column for itself, multiplied out.
std::vector<BigCount> weights_by_columns(unsigned octets) {
  std::vector<BigCount> column(octets + 1);
  BigCount ways = 1;
  for (unsigned k = 0; k <= octets; ++k) {
    if (k % 2 == 0) column[k] = ways;
    ways = ways * (octets - k) / (k + 1);
  }
  std::vector<BigCount> product{1};
  for (int factor = 0; factor < 8; ++factor) {
    std::vector<BigCount> longer(product.size() + octets);
    for (std::size_t i = 0; i < product.size(); ++i) {
      for (std::size_t k = 0; k < column.size(); ++k) longer[i + k] += product[i] * column[k];
    }
    product = std::move(longer);
  }
  return product;
}

// ((1 + (1 - 2p)^N) / 2)^8 - (1 - p)^(8N), as it is written: good where the two sides differ.
double as_written(unsigned octets, double p) {
  return std::pow((1 + std::pow(1 - 2 * p, octets)) / 2, 8) - std::pow(1 - p, 8 * octets);
}

TEST(BlockCheck, WeightsAreThoseOfItsColumns) {
  for (const unsigned octets : {1U, 2U, 3U, 4U, 5U, 17U, 64U}) {
    const BlockCheck check{octets};
    EXPECT_EQ(undetected_patterns(check, check.bits()), weights_by_columns(octets)) << octets;
  }
}

// As a cyclic code it is x^8 + 1 over the bits of the octets: the register of a frame check of 8 bits finds
// the same dual code by walking its cycles.
TEST(BlockCheck, IsTheCodeOfItsGenerator) {
  const line::FrameCheckParameters generator{"x8+1", 8, 1, 0, false, false, 0, 0, 0, false, ""};
  for (const unsigned octets : {1U, 3U, 5U, 40U}) {
    const DualWeights walked = dual_weights(generator, 8 * octets);
    const DualWeights written = dual_weights(BlockCheck{octets});
    EXPECT_EQ(written.width, walked.width);
    EXPECT_EQ(written.bits, walked.bits);
    EXPECT_EQ(written.count, walked.count) << octets;
  }
}

// The sums of all parities, made one by one: rows and columns of the 9 N bits.
TEST(BlockCheck, DualWeightsWithParityAreThoseOfAllSums) {
  for (const unsigned octets : {1U, 2U, 3U, 5U, 6U}) {
    std::vector<std::uint64_t> parities;
    for (unsigned row = 0; row < octets; ++row) parities.push_back(std::uint64_t{0x1FF} << (9 * row));
    for (unsigned column = 0; column < 8; ++column) {
      std::uint64_t bits = 0;
      for (unsigned row = 0; row < octets; ++row) bits |= std::uint64_t{1} << (9 * row + column);
      parities.push_back(bits);
    }
    std::vector<std::uint64_t> count(9 * octets + 1);
    std::uint64_t word = 0;
    for (std::uint64_t step = 1;; ++step) {
      ++count[static_cast<std::size_t>(std::popcount(word))];
      if (step >> parities.size() != 0) break;
      word ^= parities[static_cast<std::size_t>(std::countr_zero(step))];
    }
    const DualWeights dual = dual_weights(BlockCheck{octets, true});
    EXPECT_EQ(dual.count, count) << octets;
    EXPECT_EQ(dual.width, parities.size());
  }
}

RC_GTEST_PROP(BlockCheck, LetsAsManyPatternsPassAsThereAreMessages, ()) {
  const bool has_parity = *rc::gen::arbitrary<bool>();
  const BlockCheck check{*rc::gen::inRange(1U, has_parity ? kMostOctetsWithParity + 1 : 100), has_parity};
  BigCount sum = 0;
  unsigned weight = 0;
  for (const BigCount& patterns : undetected_patterns(check, check.bits())) {
    // One that passes has an even number of flips, as its columns have.
    RC_ASSERT(patterns >= 0);
    RC_ASSERT(weight % 2 == 0 || patterns == 0);
    sum += patterns;
    ++weight;
  }
  RC_ASSERT(sum == BigCount(1) << (8 * (check.octets - 1)));
}

// Two flips in one column, with parity the corners of a rectangle: 8 C(N, 2) and 36 C(N, 2).
RC_GTEST_PROP(BlockCheck, TheFewestFlipsThatPassAreAPairOrARectangle, ()) {
  const std::uint64_t octets = *rc::gen::inRange(2U, kMostOctetsWithParity + 1);
  const std::uint64_t pairs = octets * (octets - 1) / 2;
  const auto count = static_cast<unsigned>(octets);
  RC_ASSERT(undetected_patterns({count, false}, 2) == (std::vector<BigCount>{1, 0, 8 * pairs}));
  RC_ASSERT(undetected_patterns({count, true}, 4) == (std::vector<BigCount>{1, 0, 0, 0, 36 * pairs}));
  RC_ASSERT(hamming_distance(dual_weights(BlockCheck{count, false})) == 2U);
  RC_ASSERT(hamming_distance(dual_weights(BlockCheck{count, true})) == 4U);
}

TEST(BlockCheck, ProbabilityIsThatOfItsFormula) {
  for (const unsigned octets : {2U, 3U, 5U, 40U}) {
    for (const double p : {0.02, 0.1, 0.25, 0.5}) {
      const double expected = as_written(octets, p);
      EXPECT_NEAR(undetected_error_probability(BlockCheck{octets}, p), expected, 1e-11 * expected);
    }
    // Where the formula as written has no digit left, the first weight is all there is.
    const double pairs = octets * (octets - 1) / 2.0;
    EXPECT_NEAR(undetected_error_probability(BlockCheck{octets}, 1e-12) / (8 * pairs * 1e-24), 1, 1e-9);
    EXPECT_NEAR(undetected_error_probability(BlockCheck{octets, true}, 1e-12) / (36 * pairs * 1e-48), 1,
                1e-9);
  }
  // One character has nothing that could hide a flip.
  EXPECT_EQ(undetected_error_probability(BlockCheck{1}, 0.1), 0);
  EXPECT_EQ(undetected_error_probability(BlockCheck{1, true}, 0.1), 0);
}

struct PrintedRow {
  double ber;
  std::array<const char*, 4> printed;  // N = 5, N = 3, the same with parity
};

// Printed with three digits, with parity with two; the last of them may be off by one half. [calc] The source
// of the table has 2.40e-7 for three octets at 1e-4, one too many in its last digit: the first term alone, 24
// p^2 (1 - p)^22, is 2.395e-7, and the others add 2.5e-14.
TEST(BlockCheck, ProbabilitiesAreThoseOfTheTable) {
  constexpr std::array<BlockCheck, 4> kChecks{{{5, false}, {3, false}, {5, true}, {3, true}}};
  const std::array<PrintedRow, 4> rows{{{1e-1, {"2.29e-2", "2.69e-2", "5.8e-4", "1.0e-3"}},
                                        {1e-2, {"5.48e-3", "1.93e-3", "2.39e-6", "8.6e-7"}},
                                        {1e-3, {"7.70e-5", "2.35e-5", "3.5e-10", "1.1e-10"}},
                                        {1e-4, {"7.97e-7", "2.39e-7", "3.6e-14", "1.1e-14"}}}};
  for (const PrintedRow& row : rows) {
    for (std::size_t n = 0; n < kChecks.size(); ++n) {
      const std::string text = row.printed.at(n);
      const double printed = std::stod(text);
      const auto decimals = static_cast<int>(text.find('e') - text.find('.') - 1);
      const double last_digit = std::pow(10, std::stoi(text.substr(text.find('e') + 1)) - decimals);
      EXPECT_NEAR(undetected_error_probability(kChecks.at(n), row.ber), printed, 0.5 * last_digit)
          << row.ber << ", column " << n;
    }
  }
}

// Of noise one in 2^8 or 2^(N + 8) passes, near a bit-error rate of 0.1 several times as many.
TEST(BlockCheck, IsNotProper) {
  for (const auto& [check, worst_ber, times] : {std::tuple{BlockCheck{3, false}, 0.0926, 6.94},
                                                {BlockCheck{5, false}, 0.0565, 8.16},
                                                {BlockCheck{3, true}, 0.1644, 3.17},
                                                {BlockCheck{5, true}, 0.0981, 4.77}}) {
    const DualWeights dual = dual_weights(check);
    const double noise = std::ldexp(1.0, -static_cast<int>(dual.width));
    const double intact = std::ldexp(1.0, -static_cast<int>(dual.bits));
    EXPECT_NEAR(undetected_error_probability(dual, 0.5), noise - intact, 1e-15);
    EXPECT_GT(undetected_error_probability(dual, 0.1), 2 * noise);
    const WorstError worst = worst_undetected_error(dual);
    EXPECT_FALSE(worst.rises_throughout);
    EXPECT_NEAR(worst.ber, worst_ber, 1e-4);
    EXPECT_NEAR(worst.probability / noise, times, 0.01);
  }
}

TEST(BlockCheck, RefusesWhatIsNoBlock) {
  EXPECT_THROW(dual_weights(BlockCheck{0}), kernel::Error);
  EXPECT_THROW(dual_weights(BlockCheck{kMostOctetsOfBlock + 1}), kernel::Error);
  EXPECT_THROW(dual_weights(BlockCheck{kMostOctetsWithParity + 1, true}), kernel::Error);
  EXPECT_THROW(undetected_error_probability(BlockCheck{5}, 0.6), kernel::Error);
  EXPECT_GT(undetected_error_probability(BlockCheck{kMostOctetsOfBlock}, 1e-6), 0);
}

}  // namespace
}  // namespace fieldproof::emc
