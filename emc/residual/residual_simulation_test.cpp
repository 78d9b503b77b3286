#include "emc/residual/residual_simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "emc/residual/residual_error.hpp"
#include "emc/residual/weight_distribution.hpp"

namespace fieldproof::emc {
namespace {

// Five standard deviations of a binomial count around its expectation.
void expect_count(std::uint64_t count, double probability, std::uint64_t chances) {
  const double expected = probability * static_cast<double>(chances);
  EXPECT_NEAR(static_cast<double>(count), expected, 5 * std::sqrt(expected * (1 - probability)));
}

TEST(ResidualSimulation, CountsWhatIsExact) {
  for (const std::string_view name : {"CRC-8/SMBUS", "CRC-16/MODBUS"}) {
    constexpr std::uint64_t kSamples = 3'000'000;
    constexpr unsigned kBits = 60;
    constexpr double kBer = 0.1;
    const CountedErrors counted =
        count_undetected_errors(line::frame_check_named(name), kBits, kBer, kSamples, kernel::Random(7));
    const double exact =
        undetected_error_probability(dual_weights(line::frame_check_named(name), kBits), kBer);
    EXPECT_EQ(counted.samples, kSamples);
    EXPECT_GT(exact * kSamples, 30) << "too few to say anything";
    expect_count(counted.undetected, exact, kSamples);
    expect_count(counted.corrupted, 1 - std::pow(1 - kBer, kBits), kSamples);
  }
}

TEST(ResidualSimulation, CountsNothingOnAQuietLineAndEverythingWithoutARate) {
  const CountedErrors quiet =
      count_undetected_errors(line::frame_check_named("CRC-8/SMBUS"), 60, 0, 1000, kernel::Random(7));
  EXPECT_EQ(quiet.corrupted, 0U);
  // Every bit flipped in 15 bits: x^15 + 1 over x + 1, which the polynomial does not divide.
  const CountedErrors all =
      count_undetected_errors(line::frame_check_named("CRC-8/SMBUS"), 15, 1, 1000, kernel::Random(7));
  EXPECT_EQ(all.corrupted, 1000U);
  EXPECT_EQ(all.undetected, 0U);
  // In 127 bits, the order of x, it does not either, but in twice as many.
  EXPECT_EQ(count_undetected_errors(line::frame_check_named("CRC-8/SMBUS"), 254, 1, 10, kernel::Random(7))
                .undetected,
            10U);
}

TEST(ResidualSimulation, SamplesTheShareOfEachWeight) {
  const line::FrameCheckParameters& p = line::frame_check_named("CRC-16/IBM-3740");
  const SampledErrors sampled = sample_undetected_errors(p, 64, 1e-2, 340'000, kernel::Random(3));
  EXPECT_EQ(sampled.looked_up, 2U);
  const std::vector<BigCount> words = code_word_counts(dual_weights(p, 64), 64);
  double ways = 64;
  ASSERT_GE(sampled.weights.size(), 5U);
  for (const SampledWeight& one : sampled.weights) {
    ways *= static_cast<double>(64 - one.weight + 1) / one.weight;  // C(64, weight)
    const double exact = words[one.weight].convert_to<double>() / ways;
    EXPECT_NEAR(one.share, exact, 5 * one.error + 1e-300) << one.weight;
    EXPECT_EQ(one.hits == 0, exact == 0) << one.weight;
    EXPECT_NEAR(one.probability, ways * std::pow(1e-2, one.weight) * std::pow(0.99, 64 - one.weight),
                1e-9 * one.probability);
  }
}

TEST(ResidualSimulation, ReachesWhatCountingDoesNot) {
  const line::FrameCheckParameters& p = line::frame_check_named("CRC-24/BLE");
  const DualWeights dual = dual_weights(p, 512);
  for (const double ber : {1e-4, 1e-2}) {
    const SampledErrors sampled = sample_undetected_errors(p, 512, ber, 2'200'000, kernel::Random(11));
    const double exact = undetected_error_probability(dual, ber);
    EXPECT_LT(exact, 1e-7);
    EXPECT_NEAR(sampled.probability, exact, 5 * sampled.standard_error) << ber;
    EXPECT_LT(sampled.standard_error, 0.2 * exact) << ber;
    EXPECT_LT(sampled.left_out, 1e-3) << ber;
  }
}

TEST(ResidualSimulation, LooksUpOneFlipInLongTelegrams) {
  const line::FrameCheckParameters& p = line::frame_check_named("CRC-16/MODBUS");
  const SampledErrors sampled = sample_undetected_errors(p, 5000, 1e-4, 1'700'000, kernel::Random(5));
  EXPECT_EQ(sampled.looked_up, 1U);
  const double exact = undetected_error_probability(dual_weights(p, 5000), 1e-4);
  EXPECT_NEAR(sampled.probability, exact, 5 * sampled.standard_error);
  EXPECT_LT(sampled.standard_error, 0.1 * exact);
}

TEST(ResidualSimulation, RepeatsWithItsSeed) {
  const line::FrameCheckParameters& p = line::frame_check_named("CRC-16/MODBUS");
  const auto once = [&](std::uint64_t seed) {
    return sample_undetected_errors(p, 100, 1e-2, 20'000, kernel::Random(seed)).probability;
  };
  EXPECT_EQ(once(1), once(1));
  EXPECT_NE(once(1), once(2));
}

}  // namespace
}  // namespace fieldproof::emc
