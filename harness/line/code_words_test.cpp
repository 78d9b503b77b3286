#include "harness/line/code_words.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <ostream>
#include <set>
#include <string>
#include <string_view>

#include "harness/line/frame_check_16.hpp"

namespace fieldproof::line {
namespace {

// Flips one bit of a code word, counted in line order.
void flip(std::vector<std::uint8_t>& word, std::size_t position, bool least_first) {
  const std::size_t in_octet = least_first ? position % 8 : 7 - position % 8;
  word[position / 8] = static_cast<std::uint8_t>(word[position / 8] ^ (1U << in_octet));
}

// The engine's own opinion of a pattern of flips on a real code word.
bool is_detected(const FrameCheckParameters& p, std::size_t octets, const std::vector<std::size_t>& flips) {
  const FrameCheck check(p);
  std::vector<std::uint8_t> word(octets - 2);
  for (std::size_t k = 0; k < word.size(); ++k) word[k] = static_cast<std::uint8_t>(0x35 + 7 * k);
  check.append_check(word);
  for (const std::size_t position : flips) flip(word, position, p.refin);
  return !check.is_code_word(word);
}

// A name of which GoogleTest takes every letter.
std::string word_of(std::string_view name) {
  std::string word(name);
  std::erase_if(word, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
  return word;
}

struct WeightFour {
  std::string_view name;
  unsigned codeword_bits;
  std::size_t count;
};

void PrintTo(const WeightFour& row, std::ostream* out) {
  *out << row.name << ", " << row.codeword_bits;
}

class WeightFourCounts : public testing::TestWithParam<WeightFour> {};

// Counts computed independently (exhaustive, meet in the middle) for code words of n data octets with a
// loopback word: 16 + 8 n + 16 bits.
TEST_P(WeightFourCounts, AreExact) {
  const auto& [name, codeword_bits, count] = GetParam();
  const std::vector<FourBits> words = weight_four_code_words(frame_check_named(name), codeword_bits);
  EXPECT_EQ(words.size(), count);
  EXPECT_EQ(std::set<FourBits>(words.begin(), words.end()).size(), count);
}

constexpr std::string_view kInterbus = "CRC-16/IBM-3740";
constexpr std::string_view kProfibus = "CRC-16/PROFIBUS";
constexpr std::string_view kModbus = "CRC-16/MODBUS";

INSTANTIATE_TEST_SUITE_P(CodeWords, WeightFourCounts,
                         testing::Values(WeightFour{kInterbus, 48, 48}, WeightFour{kInterbus, 64, 84},
                                         WeightFour{kInterbus, 96, 259}, WeightFour{kInterbus, 160, 1196},
                                         WeightFour{kInterbus, 544, 107'465}, WeightFour{kProfibus, 48, 0},
                                         WeightFour{kProfibus, 64, 0}, WeightFour{kProfibus, 96, 0},
                                         WeightFour{kProfibus, 160, 147}, WeightFour{kModbus, 48, 140},
                                         WeightFour{kModbus, 64, 364}, WeightFour{kModbus, 96, 1165},
                                         WeightFour{kModbus, 160, 4434}),
                         [](const auto& row) {
                           return word_of(row.param.name) + "_" + std::to_string(row.param.codeword_bits);
                         });

TEST(CodeWords, OfWeightFourAreWhatTheEngineDoesNotDetect) {
  for (const std::string_view name : {kInterbus, kModbus}) {
    for (const FourBits& bits : weight_four_code_words(frame_check_named(name), 96)) {
      EXPECT_FALSE(is_detected(frame_check_named(name), 12, {bits[0], bits[1], bits[2], bits[3]}))
          << name << bits[0];
      EXPECT_TRUE(is_detected(frame_check_named(name), 12, {bits[0], bits[1], bits[2]})) << name << bits[0];
    }
  }
}

TEST(CodeWords, ContainTheGeneratorItself) {
  // x^16 + x^12 + x^5 + 1, its last term on the last bit.
  const std::vector<FourBits> words = weight_four_code_words(frame_check_named(kInterbus), 48);
  EXPECT_TRUE(std::binary_search(words.begin(), words.end(), FourBits{31, 35, 42, 47}));
}

class SixteenBitCheck : public testing::TestWithParam<std::string_view> {};

// Every pattern of one, two and three flips in a code word of 64 bits, judged by the engine and not by
// theory.
TEST_P(SixteenBitCheck, DetectsUpToThreeFlips) {
  const FrameCheckParameters& p = frame_check_named(GetParam());
  const FrameCheck16 check(p);
  std::vector<FrameCheck16::State> flip_at(64);
  for (std::size_t position = 0; position < flip_at.size(); ++position) {
    std::vector<std::uint8_t> word(8);
    flip(word, position, p.refin);
    flip_at[position] = check.update(0, word);
  }
  for (std::size_t a = 0; a < 64; ++a) {
    ASSERT_NE(flip_at[a], 0);
    for (std::size_t b = a + 1; b < 64; ++b) {
      ASSERT_NE(flip_at[a] ^ flip_at[b], 0) << a << " " << b;
      for (std::size_t c = b + 1; c < 64; ++c)
        ASSERT_NE(flip_at[a] ^ flip_at[b] ^ flip_at[c], 0) << a << b << c;
    }
  }
  EXPECT_TRUE(is_detected(p, 12, {3}));
  EXPECT_FALSE(has_code_word(p, 2000, 3));
}

// All bursts of at most 16 bits (first and last flipped, anything between) are detected wherever they start;
// of those of exactly 17 bits one in 2^15 is not.
TEST_P(SixteenBitCheck, DetectsBurstsUpToItsWidth) {
  const FrameCheckParameters& p = frame_check_named(GetParam());
  const FrameCheck16 check(p);
  std::size_t undetected_of_17 = 0;
  for (std::uint32_t pattern = 1; pattern < (1U << 17); pattern += 2) {
    FrameCheck16::State state = 0;
    for (unsigned bit = 0; bit < 17; ++bit) state = check.update_bit(state, ((pattern >> bit) & 1) != 0);
    for (unsigned behind = 0; behind < 40; ++behind) {
      if (pattern < (1U << 16)) {
        ASSERT_NE(state, 0) << pattern << " " << behind;
      } else if (state == 0 && behind == 0) {
        ++undetected_of_17;
      }
      state = check.update_bit(state, false);
    }
  }
  EXPECT_EQ(undetected_of_17, 1U);
}

INSTANTIATE_TEST_SUITE_P(CodeWords, SixteenBitCheck, testing::Values(kInterbus, kProfibus, kModbus, "X-25"),
                         [](const auto& row) { return word_of(row.param); });

struct HammingDistances {
  std::string_view name;
  std::uint64_t order_of_x;                // code words of one bit more have two-bit errors that nobody sees
  std::array<std::uint32_t, 7> data_bits;  // the longest data with Hamming distance 4, 5, ... 10; 0: none
};

void PrintTo(const HammingDistances& row, std::ostream* out) {
  *out << row.name;
}

class HammingDistance : public testing::TestWithParam<HammingDistances> {};

// The header check of MS/TP, x^8 + x^7 + 1, is in no catalogue.
FrameCheckParameters row_of(std::string_view name) {
  if (name == "MS/TP header") return {"MS/TP header", 8, 0x81, 0, true, true, 0, 0, 0, false, ""};
  return frame_check_named(name);
}

TEST_P(HammingDistance, HoldsUpToTheListedLengthAndNoFurther) {
  const FrameCheckParameters p = row_of(GetParam().name);
  for (unsigned k = 0; k < GetParam().data_bits.size(); ++k) {
    const unsigned data_bits = GetParam().data_bits[k];
    const unsigned undetected = 3 + k;  // flips that break the distance
    if (data_bits > 0) {
      EXPECT_FALSE(has_code_word(p, data_bits + p.width, undetected)) << undetected;
    }
    EXPECT_TRUE(has_code_word(p, data_bits + p.width + 1, undetected)) << undetected;
  }
}

// x has exactly the listed order: its power is 1 there and at no divisor by a prime.
TEST_P(HammingDistance, ThreeEndsWithTheOrderOfX) {
  const FrameCheckParameters p = row_of(GetParam().name);
  const std::uint64_t order = GetParam().order_of_x;
  EXPECT_EQ(power_of_x(p, order), 1U);
  std::uint64_t rest = order;
  for (std::uint64_t prime = 2; rest > 1; ++prime) {
    if (prime * prime > rest) prime = rest;
    if (rest % prime != 0) continue;
    EXPECT_NE(power_of_x(p, order / prime), 1U) << prime;
    while (rest % prime == 0) rest /= prime;
  }
}

// Data bits from an exhaustive search with a published tool, recomputed independently. The order of x less
// the width is the listed length for distance 3.
INSTANTIATE_TEST_SUITE_P(
    CodeWords, HammingDistance,
    testing::Values(HammingDistances{kProfibus, 2759, {2743, 104, 11, 10, 8, 1, 1}},
                    HammingDistances{kInterbus, 32767, {32751, 0, 0, 0, 0, 0, 0}},
                    HammingDistances{kModbus, 32767, {32751, 0, 0, 0, 0, 0, 0}},
                    HammingDistances{"CRC-15/CAN", 127, {112, 112, 112, 7, 7, 0, 0}},
                    HammingDistances{"CRC-32", 4294967295, {91607, 2974, 268, 171, 91, 57, 34}},
                    HammingDistances{"CRC-8/SMBUS", 127, {119, 0, 0, 0, 0, 0, 0}},
                    HammingDistances{"CRC-16/DNP", 151, {135, 135, 135, 6, 6, 4, 4}},
                    HammingDistances{"CRC-17/CAN-FD", 255, {238, 238, 238, 2, 2, 2, 2}},
                    HammingDistances{"CRC-21/CAN-FD", 1023, {1002, 1002, 1002, 8, 8, 0, 0}},
                    HammingDistances{"MS/TP header", 63, {0, 0, 0, 0, 0, 0, 0}}),
    [](const auto& row) { return word_of(row.param.name); });

}  // namespace
}  // namespace fieldproof::line
