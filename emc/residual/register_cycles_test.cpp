#include "emc/residual/register_cycles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

namespace fieldproof::emc {
namespace {

unsigned degree_of(Polynomial p) {
  return static_cast<unsigned>(std::bit_width(p)) - 1;
}

Polynomial product_of(const std::vector<PrimePower>& factors) {
  Polynomial product = 1;
  for (const PrimePower& factor : factors) {
    for (unsigned k = 0; k < factor.exponent; ++k) {
      Polynomial next = 0;
      for (unsigned bit = 0; bit <= degree_of(factor.prime); ++bit) {
        if (((factor.prime >> bit) & 1) != 0) next ^= product << bit;
      }
      product = next;
    }
  }
  return product;
}

TEST(RegisterCycles, HoldEverySequenceOnceForEveryPolynomialUpToDegreeTen) {
  for (Polynomial p = 3; degree_of(p) <= 10; p += 2) {
    std::vector<bool> is_seen(std::size_t{1} << degree_of(p));
    for (const RegisterCycle& cycle : register_cycles(p)) {
      std::uint64_t at = cycle.start;
      for (std::uint64_t i = 0; i < cycle.length; ++i, at = shifted(at, p)) {
        ASSERT_FALSE(is_seen[at]) << p << ", " << at;
        is_seen[at] = true;
      }
      ASSERT_EQ(at, cycle.start) << p;
    }
    EXPECT_EQ(std::count(is_seen.begin(), is_seen.end(), false), 0) << p;
  }
}

TEST(RegisterCycles, FactorsMultiplyToThePolynomial) {
  for (Polynomial p = 3; degree_of(p) <= 10; p += 2) {
    const auto factors = factors_of(p);
    EXPECT_EQ(product_of(factors), p);
    for (const PrimePower& factor : factors) {
      EXPECT_EQ(factors_of(factor.prime), (std::vector<PrimePower>{{factor.prime, 1}})) << p;
    }
  }
}

// Factored independently.
TEST(RegisterCycles, FactorsOfChecksInUse) {
  using Factors = std::vector<PrimePower>;
  EXPECT_EQ(factors_of(0x11021), (Factors{{0x3, 1}, {0xF01F, 1}}));
  EXPECT_EQ(factors_of(0x11DCF), (Factors{{0x37, 1}, {0xEC9, 1}}));
  EXPECT_EQ(factors_of(0x18005), (Factors{{0x3, 1}, {0x8003, 1}}));
  EXPECT_EQ(factors_of(0x104C11DB7), (Factors{{0x104C11DB7, 1}}));
  EXPECT_EQ(factors_of(0x18001801B), (Factors{{0x3, 2}, {0x8003, 1}, {0xFFFD, 1}}));
}

TEST(RegisterCycles, LengthsAreTheOrdersOfTheFactors) {
  // 0x37 is primitive (31), 0xEC9 has order 89: 23 cycles of it, and as many of both together.
  std::vector<std::uint64_t> count(2760);
  for (const RegisterCycle& cycle : register_cycles(0x11DCF)) ++count.at(cycle.length);
  EXPECT_EQ(count.at(1), 1U);
  EXPECT_EQ(count.at(31), 1U);
  EXPECT_EQ(count.at(89), 23U);
  EXPECT_EQ(count.at(2759), 23U);
  const auto primitive = register_cycles(0x104C11DB7);
  ASSERT_EQ(primitive.size(), 2U);
  EXPECT_EQ(primitive.back().length, 0xFFFFFFFFU);
}

}  // namespace
}  // namespace fieldproof::emc
