#include "emc/residual/dual_weights.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <numeric>
#include <string_view>

#include "harness/kernel/error.hpp"
#include "harness/line/code_words.hpp"

namespace fieldproof::emc {
namespace {

// The 2^r words one after the other, each from the one before by one parity: an independent way that knows
// neither cycles nor windows.
std::vector<std::uint64_t> weights_by_gray_code(const line::FrameCheckParameters& p, unsigned bits) {
  constexpr unsigned kWords = 4;
  std::vector<std::array<std::uint64_t, kWords>> parities(p.width);
  for (unsigned position = 0; position < bits; ++position) {
    const std::uint64_t remainder = line::power_of_x(p, position);
    for (unsigned r = 0; r < p.width; ++r) {
      parities[r].at(position / 64) |= ((remainder >> r) & 1) << (position % 64);
    }
  }
  std::vector<std::uint64_t> count(bits + 1);
  std::array<std::uint64_t, kWords> word{};
  for (std::uint64_t step = 1;; ++step) {
    int weight = 0;
    for (const std::uint64_t part : word) weight += std::popcount(part);
    ++count[static_cast<std::size_t>(weight)];
    if (step >> p.width != 0) return count;
    for (unsigned i = 0; i < kWords; ++i) {
      word.at(i) ^= parities[static_cast<std::size_t>(std::countr_zero(step))].at(i);
    }
  }
}

TEST(DualWeights, AreThoseOfAllSumsForEveryShortCheckOfTheCatalogue) {
  for (const line::FrameCheckParameters& p : line::frame_check_catalogue()) {
    if (p.width > 12) continue;
    for (const unsigned bits : {1U, p.width - 1, p.width, p.width + 1, 63U, 64U, 65U, 127U, 128U, 200U}) {
      EXPECT_EQ(dual_weights(p, bits).count, weights_by_gray_code(p, bits)) << p.name << ", " << bits;
    }
  }
}

TEST(DualWeights, AreThoseOfAllSumsForChecksOfSixteenBits) {
  for (const std::string_view name : {"CRC-16/IBM-3740", "CRC-16/PROFIBUS", "CRC-16/MODBUS", "CRC-16/DECT-R",
                                      "CRC-16/LJ1200", "CRC-16/TELEDISK", "CRC-15/CAN"}) {
    for (const unsigned bits : {17U, 130U, 256U}) {
      EXPECT_EQ(dual_weights(line::frame_check_named(name), bits).count,
                weights_by_gray_code(line::frame_check_named(name), bits))
          << name;
    }
  }
}

// From 2^22 words on four windows are counted at once: one long cycle, one with complements, many short ones.
TEST(DualWeights, AreThoseOfAllSumsForChecksOfTwentyFourBits) {
  for (const std::string_view name : {"CRC-24/OPENPGP", "CRC-24/BLE", "CRC-24/FLEXRAY-A"}) {
    for (const unsigned bits : {25U, 64U, 150U}) {
      EXPECT_EQ(dual_weights(line::frame_check_named(name), bits).count,
                weights_by_gray_code(line::frame_check_named(name), bits))
          << name;
    }
  }
}

// Windows that reach beyond a block of the walk, and beyond the whole cycle.
TEST(DualWeights, HaveTheirMeanAndSpreadAtTheLongestTelegram) {
  const DualWeights dual = dual_weights(line::frame_check_named("CRC-16/IBM-3740"), kMostBits);
  // Any two columns that differ are independent, so the mean is n / 2 and the variance n / 4, but the order
  // of x is 32767: each column stands there four times, the first four a fifth time.
  const std::uint64_t order = 32767;
  const double repeats = static_cast<double>(kMostBits / order);
  const double rest = static_cast<double>(kMostBits % order);
  double mean = 0;
  double variance = 0;
  for (std::size_t j = 0; j < dual.count.size(); ++j) {
    const double share = static_cast<double>(dual.count[j]) * 0x1p-16;
    const double off = static_cast<double>(j) - kMostBits / 2.0;
    mean += share * off;
    variance += share * off * off;
  }
  EXPECT_EQ(mean, 0);
  const double expected =
      ((static_cast<double>(order) - rest) * repeats * repeats + rest * (repeats + 1) * (repeats + 1)) / 4;
  EXPECT_DOUBLE_EQ(variance, expected);
}

TEST(DualWeights, TellsItsProgress) {
  const line::FrameCheckParameters& p = line::frame_check_named("CRC-16/IBM-3740");
  std::uint64_t last = 0;
  dual_weights(p, 100, [&](std::uint64_t done) {
    EXPECT_GT(done, last);
    last = done;
  });
  EXPECT_EQ(last, words_to_weigh(p));
  EXPECT_EQ(words_to_weigh(p), 1U << 15);  // the factor x + 1 is not walked
  EXPECT_EQ(words_to_weigh(line::frame_check_named("CRC-16/PROFIBUS")), 1U << 16);
}

TEST(DualWeights, RefuseWhatIsTooWideOrTooLong) {
  EXPECT_THROW(dual_weights(line::frame_check_named("CRC-40/GSM"), 100), kernel::Error);
  EXPECT_THROW(dual_weights(line::frame_check_named("CRC-8/SMBUS"), 0), kernel::Error);
  EXPECT_THROW(dual_weights(line::frame_check_named("CRC-8/SMBUS"), kMostBits + 1), kernel::Error);
  EXPECT_NO_THROW(dual_weights(line::frame_check_named("CRC-8/SMBUS"), kMostBits));
}

}  // namespace
}  // namespace fieldproof::emc
