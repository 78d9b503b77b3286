#include "emc/residual/weight_distribution.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <ostream>
#include <string>
#include <string_view>

#include "harness/line/code_words.hpp"

namespace fieldproof::emc {
namespace {

constexpr std::string_view kInterbus = "CRC-16/IBM-3740";
constexpr std::string_view kProfibus = "CRC-16/PROFIBUS";
constexpr std::string_view kModbus = "CRC-16/MODBUS";

std::string letters_of(std::string_view name) {
  std::string word(name);
  std::erase_if(word, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return word;
}

// The engine that checks telegrams sends every message of so many bits; what differs from the telegram of
// zeros is a code word.
std::vector<BigCount> weights_by_sending(const line::FrameCheckParameters& p, unsigned bits) {
  const line::FrameCheck check(p);
  const unsigned message_bits = bits - p.width;
  const auto telegram_of = [&](std::uint64_t message) {
    auto state = check.start();
    for (unsigned i = 0; i < message_bits; ++i) state = check.update_bit(state, ((message >> i) & 1) != 0);
    for (unsigned k = 0; k < p.width; ++k) {
      message |= std::uint64_t{check.check_bit(state, k)} << (message_bits + k);
    }
    return message;
  };
  std::vector<BigCount> words(bits + 1);
  const std::uint64_t zeros = telegram_of(0);
  for (std::uint64_t message = 0; message < std::uint64_t{1} << message_bits; ++message) {
    ++words[static_cast<std::size_t>(std::popcount(telegram_of(message) ^ zeros))];
  }
  return words;
}

TEST(WeightDistribution, IsThatOfEveryTelegramSentForAllChecksOfTheCatalogue) {
  for (const line::FrameCheckParameters& p : line::frame_check_catalogue()) {
    if (p.width > 17) continue;
    for (const unsigned message_bits : {1U, 2U, 7U, 11U}) {
      const unsigned bits = p.width + message_bits;
      EXPECT_EQ(code_word_counts(dual_weights(p, bits), bits), weights_by_sending(p, bits)) << p.name;
    }
  }
}

TEST(WeightDistribution, HasOnlyTheTelegramItselfWhereThereIsNoRoomForAMessage) {
  for (const unsigned bits : {1U, 15U, 16U}) {
    std::vector<BigCount> words(bits + 1);
    words[0] = 1;
    EXPECT_EQ(code_word_counts(dual_weights(line::frame_check_named(kInterbus), bits), bits), words);
    EXPECT_EQ(hamming_distance(dual_weights(line::frame_check_named(kInterbus), bits)), std::nullopt);
  }
  EXPECT_EQ(hamming_distance(dual_weights(line::frame_check_named(kInterbus), 17)),
            4U);  // the generator has four terms
}

RC_GTEST_PROP(WeightDistribution, SumsUpToAllMessagesAtAnyLength, ()) {
  const auto catalogue = line::frame_check_catalogue();
  const auto widest =
      std::find_if(catalogue.begin(), catalogue.end(), [](const auto& p) { return p.width > 16; });
  const auto& p =
      catalogue[*rc::gen::inRange<std::size_t>(0, static_cast<std::size_t>(widest - catalogue.begin()))];
  const unsigned bits = p.width + *rc::gen::inRange(0U, 400U);
  BigCount sum = 0;
  for (const BigCount& words : code_word_counts(dual_weights(p, bits), bits)) {
    RC_ASSERT(words >= 0);
    sum += words;
  }
  RC_ASSERT(sum == BigCount(1) << (bits - p.width));
}

struct WeightFour {
  std::string_view name;
  unsigned bits;
  std::uint64_t two;
  std::uint64_t four;
};

void PrintTo(const WeightFour& row, std::ostream* out) {
  *out << row.name << ", " << row.bits;
}

class WeightsTwoAndFour : public testing::TestWithParam<WeightFour> {};

TEST_P(WeightsTwoAndFour, AreThoseOfTheTable) {
  const auto& [name, bits, two, four] = GetParam();
  const std::vector<BigCount> words = code_word_counts(dual_weights(line::frame_check_named(name), bits), 4);
  EXPECT_EQ(words, (std::vector<BigCount>{1, 0, two, name == kProfibus && bits > 2759 ? words[3] : 0, four}));
}

// Pairs of positions by their sum: two pairs of equal sum are a code word of weight four, found three times,
// or share a position, and then the other two are a code word of weight two.
TEST_P(WeightsTwoAndFour, AreThoseOfCountingPairs) {
  const auto& [name, bits, two, four] = GetParam();
  std::vector<std::uint64_t> remainders;
  for (unsigned i = 0; i < bits; ++i)
    remainders.push_back(line::power_of_x(line::frame_check_named(name), i));
  std::vector<std::uint64_t> pairs(1U << 16);
  for (unsigned i = 0; i < bits; ++i) {
    for (unsigned j = i + 1; j < bits; ++j) ++pairs[remainders[i] ^ remainders[j]];
  }
  std::uint64_t pairs_of_pairs = 0;
  for (const std::uint64_t count : pairs) pairs_of_pairs += count * (count - 1) / 2;
  EXPECT_EQ(pairs[0], two);
  EXPECT_EQ((pairs_of_pairs - two * (bits - 2)) / 3, four);
  EXPECT_EQ((pairs_of_pairs - two * (bits - 2)) % 3, 0U);
}

// Telegrams of n data octets with a loopback word: 16 + 8 n + 16 bits, n = 2, 4, 8, 16, 64, 512. [calc]
// The source of the table has 280777665 in the row of PROFIBUS at 4128 bits: there are words of weight two
// there (the order of x is 2759), and pairs of pairs that share a position were counted with it.
INSTANTIATE_TEST_SUITE_P(
    WeightDistribution, WeightsTwoAndFour,
    testing::Values(WeightFour{kInterbus, 48, 0, 48}, WeightFour{kInterbus, 64, 0, 84},
                    WeightFour{kInterbus, 96, 0, 259}, WeightFour{kInterbus, 160, 0, 1196},
                    WeightFour{kInterbus, 544, 0, 107'465}, WeightFour{kInterbus, 4128, 0, 368'889'580},
                    WeightFour{kProfibus, 48, 0, 0}, WeightFour{kProfibus, 96, 0, 0},
                    WeightFour{kProfibus, 160, 0, 147}, WeightFour{kProfibus, 544, 0, 73'238},
                    WeightFour{kProfibus, 4128, 1369, 278'894'834}, WeightFour{kModbus, 48, 0, 140},
                    WeightFour{kModbus, 64, 0, 364}, WeightFour{kModbus, 96, 0, 1165},
                    WeightFour{kModbus, 160, 0, 4434}, WeightFour{kModbus, 544, 0, 181'035},
                    WeightFour{kModbus, 4128, 0, 369'300'322}),
    [](const auto& row) { return letters_of(row.param.name) + "_" + std::to_string(row.param.bits); });

struct HammingDistances {
  std::string_view name;
  std::vector<unsigned> data_bits;  // the longest data with distance 3, 4, 5, ...; 0: none
};

void PrintTo(const HammingDistances& row, std::ostream* out) {
  *out << row.name;
}

class HammingDistance : public testing::TestWithParam<HammingDistances> {};

TEST_P(HammingDistance, HoldsUpToTheListedLengthAndNoFurther) {
  const line::FrameCheckParameters& p = line::frame_check_named(GetParam().name);
  unsigned distance = 3;
  for (const unsigned data_bits : GetParam().data_bits) {
    if (data_bits > 0) {
      EXPECT_GE(hamming_distance(dual_weights(p, data_bits + p.width)), distance) << data_bits;
    }
    EXPECT_LT(hamming_distance(dual_weights(p, data_bits + p.width + 1)), distance) << data_bits;
    ++distance;
  }
}

// From an exhaustive search with a published tool (hdlen 1.1.0) and an independent recomputation. [calc]
INSTANTIATE_TEST_SUITE_P(WeightDistribution, HammingDistance,
                         testing::Values(HammingDistances{kProfibus, {2743, 2743, 104, 11, 10, 8, 1, 1}},
                                         HammingDistances{kInterbus, {32751, 32751, 0, 0, 0, 0, 0, 0}},
                                         HammingDistances{kModbus, {32751, 32751, 0, 0, 0, 0, 0, 0}},
                                         HammingDistances{"CRC-15/CAN", {112, 112, 112, 112, 7, 7, 0, 0}},
                                         HammingDistances{"CRC-8/SMBUS", {119, 119, 0, 0, 0, 0, 0, 0}},
                                         HammingDistances{"CRC-16/DNP", {135, 135, 135, 135, 6, 6, 4, 4}},
                                         HammingDistances{"CRC-17/CAN-FD", {238, 238, 238, 238, 2, 2, 2, 2}},
                                         HammingDistances{"CRC-21/CAN-FD",
                                                          {1002, 1002, 1002, 1002, 8, 8, 0, 0}}),
                         [](const auto& row) { return letters_of(row.param.name); });

// One row of the same table for 32 bits; the others take minutes and are in the README.
TEST(WeightDistribution, OfThirtyTwoBitsHasTheListedDistance) {
  const std::vector<BigCount> words =
      code_word_counts(dual_weights(line::frame_check_named("CRC-32"), 268 + 32), 6);
  EXPECT_EQ((std::vector<BigCount>(words.begin(), words.begin() + 6)),
            (std::vector<BigCount>{1, 0, 0, 0, 0, 0}));
  EXPECT_GT(words[6], 0);
}

}  // namespace
}  // namespace fieldproof::emc
