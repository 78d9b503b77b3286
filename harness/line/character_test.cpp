#include "harness/line/character.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

#include "harness/kernel/check.hpp"

namespace fieldproof::line {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kPicosecond;
using kernel::kStart;

constexpr std::int64_t kBitRate = 62'500;  // 16 us per bit, 1 us per sixteenth
constexpr CharacterFormat kPlain{};
constexpr CharacterFormat kEven{8, Parity::even, StopBits::one};

CharacterFormat any_format(bool with_half_bits) {
  return {*rc::gen::inRange(5U, 10U),
          *rc::gen::element(Parity::none, Parity::even, Parity::odd, Parity::mark, Parity::space),
          with_half_bits ? *rc::gen::element(StopBits::one, StopBits::one_and_a_half, StopBits::two)
                         : *rc::gen::element(StopBits::one, StopBits::two)};
}

std::vector<Character> decoded(const CharacterFormat& format, const Levels& levels) {
  std::vector<Character> characters;
  CharacterCode(format).decode(levels, 0,
                               [&](const Character& character) { characters.push_back(character); });
  return characters;
}

std::vector<Character> received(const CharacterFormat& format, const Waveform& wave, Sampling sampling = {}) {
  std::vector<CharacterReceiver::Received> all;
  CharacterReceiver(format, kBitRate, sampling).receive(wave, all);
  std::vector<Character> characters;
  for (const auto& one : all) characters.push_back(one.character);
  return characters;
}

// What a receiver hears of characters sent at another rate.
std::string heard(const CharacterFormat& format, std::int64_t rate, const std::vector<unsigned>& sent,
                  Sampling sampling = {}) {
  const CharacterCode code(format);
  Waveform wave;
  wave.rate = rate;
  for (const unsigned data : sent) code.append(wave.levels, data);
  std::string text;
  for (const Character& character : received(format, wave, sampling)) {
    text += std::to_string(character.data) + (character.is_stop_missing ? "! " : " ");
  }
  return text;
}

TEST(Character, IsWrittenLowestBitFirst) {
  Levels levels;
  CharacterCode(kEven).append(levels, 0x13);
  EXPECT_EQ(levels.text(), "01100100011");  // start, 1 1 0 0 1 0 0 0, parity 1, stop
  Levels two;
  CharacterCode({7, Parity::odd, StopBits::two}).append(two, 0x41);
  EXPECT_EQ(two.text(), "01000001111");
  Levels halves;
  CharacterCode({5, Parity::none, StopBits::one_and_a_half}).append(halves, 0x15);
  EXPECT_EQ(halves.text(), "001100110011111");
}

TEST(Character, HasTheDissectorOfItsFormat) {
  EXPECT_EQ(kPlain.text(), "8n1");
  EXPECT_EQ((CharacterFormat{5, Parity::mark, StopBits::one_and_a_half}).text(), "5m1.5");
}

TEST(Character, HasFiveToNineDataBits) {
  EXPECT_THROW(CharacterCode({4, Parity::none, StopBits::one}), kernel::BrokenInvariant);
  EXPECT_NO_THROW(CharacterCode({5, Parity::none, StopBits::one}));
  EXPECT_NO_THROW(CharacterCode({9, Parity::none, StopBits::one}));
  EXPECT_THROW(CharacterCode({10, Parity::none, StopBits::one}), kernel::BrokenInvariant);
}

TEST(Character, ErrorsAreValuesAndTheNextOneIsFoundBehindIdleLine) {
  Levels levels;
  const CharacterCode code(kEven);
  code.append(levels, 0x55);
  levels.flip(1);        // parity
  levels.append(0, 11);  // break
  levels.append(0, 5);   // still low: no start
  levels.append_idle(1);
  code.append(levels, 0x0F);
  code.append(levels, 0x01);
  levels.flip(levels.size() - 1);  // stop
  const std::vector<Character> characters = decoded(kEven, levels);
  ASSERT_EQ(characters.size(), 4U);
  EXPECT_TRUE(characters[0].is_parity_wrong);
  EXPECT_FALSE(characters[0].is_stop_missing);
  EXPECT_TRUE(characters[1].is_break);
  EXPECT_TRUE(characters[1].is_stop_missing);
  EXPECT_TRUE(characters[2].is_good());
  EXPECT_EQ(characters[2].data, 0x0F);
  EXPECT_TRUE(characters[3].is_stop_missing);
  EXPECT_FALSE(characters[3].is_break);
}

TEST(CharacterReceiver, RefusesAStartThatIsNotLowInMostOfItsMiddle) {
  // A glitch on the idle line, in picoseconds' grain, told by its length.
  const auto is_taken = [](Duration length, Sampling sampling) {
    Waveform wave;
    wave.rate = 1'000'000'000'000 / length.count();
    wave.levels.append(0, 1);
    return !received(kPlain, wave, sampling).empty();
  };
  const Sampling majority;
  EXPECT_FALSE(is_taken(7 * kMicrosecond, majority));
  EXPECT_FALSE(is_taken(8 * kMicrosecond, majority));
  EXPECT_TRUE(is_taken(8 * kMicrosecond + kMicrosecond / 100, majority));
  EXPECT_FALSE(is_taken(8 * kMicrosecond, kMidBit));
  EXPECT_TRUE(is_taken(8 * kMicrosecond + kMicrosecond / 100, kMidBit));
}

TEST(CharacterReceiver, FindsACharacterBehindARefusedGlitch) {
  Waveform wave;
  wave.rate = kBitRate * 16;
  wave.levels.append_fill(false, 3);
  wave.levels.append_idle(20);
  const CharacterCode code(kPlain);
  Levels bits;
  code.append(bits, 0xA7);
  for (std::size_t n = 0; n < bits.size(); ++n) wave.levels.append_fill(bits[n], 16);
  const std::vector<Character> characters = received(kPlain, wave);
  ASSERT_EQ(characters.size(), 1U);
  EXPECT_EQ(characters[0].data, 0xA7);
  EXPECT_EQ(characters[0].level, 23U);
}

TEST(CharacterReceiver, AGlitchJustBeforeTheStartShiftsTheSamplingGrid) {
  // The glitch begins `early` sixteenths before the true edge and ends at once: the clock starts with it.
  const auto first_start = [](std::size_t early) {
    Waveform wave;
    wave.rate = kBitRate * 16;
    wave.levels.append_fill(false, 1);
    wave.levels.append_idle(early - 1);
    for (unsigned bit = 0; bit < 10; ++bit) wave.levels.append_fill(bit % 2 != 0, 16);
    const std::vector<Character> characters = received(kPlain, wave);
    return characters.empty() ? 999U : characters[0].level;
  };
  EXPECT_EQ(first_start(7), 0U);
  EXPECT_EQ(first_start(8), 0U);
  EXPECT_EQ(first_start(9), 9U) << "two of three samples see the line idle again";
}

// The last bit looked at is the stop bit: 9 whole bits after the edge, first sample wanted 9 + 8/16
// (middle). A faster sender's stop bit ends at 10 of its bits: 10/9.5 = 1.0526; a slower one's begins at 9:
// 9/9.5.
TEST(CharacterReceiver, BearsRatesUpToBothLimits) {
  const std::vector<unsigned> sent{0x00};
  EXPECT_EQ(heard(kPlain, kBitRate * 948 / 1000, sent, kMidBit), "0 ");
  EXPECT_EQ(heard(kPlain, kBitRate * 947 / 1000, sent, kMidBit), "0! ");
  const std::vector<unsigned> two{0x80, 0x80};
  EXPECT_EQ(heard(kPlain, kBitRate * 1052 / 1000, two, kMidBit), "128 128 ");
  EXPECT_NE(heard(kPlain, kBitRate * 1053 / 1000, two, kMidBit), "128 128 ");
}

RC_GTEST_PROP(Character, RoundTripsInEveryFormat, (const std::vector<std::uint16_t>& data)) {
  const CharacterFormat format = any_format(true);
  const CharacterCode code(format);
  Waveform wave;
  wave.rate = kBitRate * code.levels_per_bit();
  for (const unsigned value : data) {
    code.append(wave.levels, value);
    wave.levels.append_idle(*rc::gen::inRange<std::size_t>(0, 4) * code.levels_per_bit());
  }
  const std::vector<Character> characters = received(format, wave);
  RC_ASSERT(characters.size() == data.size());
  for (std::size_t n = 0; n < data.size(); ++n) {
    RC_ASSERT(characters[n].is_good());
    RC_ASSERT(characters[n].data == (data[n] & ((1U << format.data_bits) - 1)));
  }
}

RC_GTEST_PROP(CharacterReceiver, FindsWhatTheFastDecoderFindsInBitWideLevels,
              (const std::vector<std::uint64_t>& words)) {
  const CharacterFormat format = any_format(false);
  Waveform wave;
  wave.start = kStart + Duration{*rc::gen::inRange<std::int64_t>(0, 1'000'000'000)};
  wave.rate = kBitRate;
  for (const std::uint64_t word : words) wave.levels.append(word, 64);
  wave.levels.append_idle(16);
  const Sampling sampling{*rc::gen::element(Sampling::Kind::majority_of_three, Sampling::Kind::mid_bit)};
  RC_ASSERT(received(format, wave, sampling) == decoded(format, wave.levels));
}

TEST(CharacterReceiver, SaysHowLongACharacterKeepsTheLineBusy) {
  constexpr Duration kBit = 16 * kMicrosecond;
  const CharacterFormat nine{9, Parity::none, StopBits::one};
  Waveform wave;
  wave.rate = kBitRate;
  CharacterCode(nine).append(wave.levels, 0x1FF);
  wave.levels.append_fill(false, 40);  // a break
  wave.levels.append_idle(3);
  CharacterCode(nine).append(wave.levels, 0x100);
  std::vector<CharacterReceiver::Received> received;
  CharacterReceiver(nine, kBitRate).receive(wave, received);
  ASSERT_EQ(received.size(), 3U);
  EXPECT_EQ(received[0].busy_until, kStart + 11 * kBit);  // to the end of its stop bit
  EXPECT_TRUE(received[1].character.is_break);
  EXPECT_EQ(received[1].busy_until, kStart + 51 * kBit);  // until the line is let go
  EXPECT_EQ(received[2].busy_until, kStart + 65 * kBit);
}

}  // namespace
}  // namespace fieldproof::line
