#include "harness/line/waveform.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <utility>
#include <vector>

namespace fieldproof::line {
namespace {

using kernel::kMicrosecond;
using kernel::kPicosecond;
using kernel::kStart;

Levels levels_of(const std::vector<bool>& bits) {
  Levels levels;
  for (const bool bit : bits) levels.append(bit ? 1 : 0, 1);
  return levels;
}

TEST(Levels, ReadsIdleBeyondTheEnd) {
  Levels levels;
  levels.append(0, 3);
  EXPECT_EQ(levels.text(), "000");
  EXPECT_TRUE(levels[3]);
  EXPECT_TRUE(levels[100'000]);
  EXPECT_EQ(levels.window(0), ~std::uint64_t{7});
  EXPECT_EQ(levels.window(3), ~std::uint64_t{0});
}

RC_GTEST_PROP(LevelsProperty, AppendingInPiecesIsAppendingBitByBit, (std::vector<std::uint64_t> words)) {
  Levels pieces;
  std::vector<bool> bits;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto count = static_cast<unsigned>((words[i] >> 32) % 65);
    pieces.append(words[i], count);
    for (unsigned n = 0; n < count; ++n) bits.push_back(((words[i] >> n) & 1) != 0);
    const std::size_t idle = words[i] % 7 == 0 ? words[i] % 200 : 0;
    pieces.append_idle(idle);
    bits.insert(bits.end(), idle, true);
  }
  RC_ASSERT(pieces == levels_of(bits));
  for (std::size_t first = 0; first <= bits.size(); first += 13) {
    const std::uint64_t window = pieces.window(first);
    for (unsigned n = 0; n < 64; ++n) {
      const bool expected = first + n >= bits.size() || bits[first + n];
      RC_ASSERT((((window >> n) & 1) != 0) == expected);
    }
  }
}

RC_GTEST_PROP(LevelsProperty, SlicesAndConcatenationsAreThoseOfTheText,
              (std::vector<bool> a, std::vector<bool> b)) {
  const Levels first = levels_of(a);
  const Levels second = levels_of(b);
  Levels both = first;
  both.append(second);
  RC_ASSERT(both.text() == first.text() + second.text());
  RC_ASSERT(both.slice(a.size(), b.size()) == second);
  both.resize(a.size());
  RC_ASSERT(both == first);
  both.append_idle(3);
  RC_ASSERT(both.text() == first.text() + "111");
}

// 64 times is a case of its own when it begins with a word.
RC_GTEST_PROP(LevelsProperty, StretchingIsWritingEachLevelSeveralTimes, (std::vector<bool> bits)) {
  const std::size_t times = *rc::gen::element<std::size_t>(1, 2, 3, 63, 64, 65, 128);
  const std::size_t before = *rc::gen::element<std::size_t>(0, 1, 64);
  Levels stretched;
  stretched.append_idle(before);
  std::string expected = stretched.text();
  stretched.append_stretched(levels_of(bits), times);
  for (const bool bit : bits) expected.append(times, bit ? '1' : '0');
  RC_ASSERT(stretched.text() == expected);
  stretched.append_idle(1);
  RC_ASSERT(stretched.text() == expected + "1");
}

TEST(Levels, FillsFromAnyPlaceForAnyLength) {
  for (const std::size_t begin : {0U, 1U, 63U, 64U, 65U}) {
    for (const std::size_t count : {0U, 1U, 62U, 63U, 64U, 65U, 128U, 1000U}) {
      for (const bool level : {false, true}) {
        Levels levels;
        for (std::size_t n = 0; n < begin; ++n) levels.append(n % 2, 1);
        std::string expected = levels.text();
        levels.append_fill(level, count);
        levels.append(0b01, 2);
        expected += std::string(count, level ? '1' : '0') + "10";
        ASSERT_EQ(levels.text(), expected) << begin << " " << count;
        ASSERT_EQ(levels.window(levels.size()), ~std::uint64_t{0});  // idle behind the end
      }
    }
  }
}

TEST(Levels, ClearLeavesAnIdleLine) {
  Levels levels;
  levels.append_fill(false, 1000);
  levels.clear();
  levels.append_idle(1000);
  EXPECT_EQ(levels.text(), std::string(1000, '1'));
}

TEST(Levels, MayBeFilledAgainWhenTheyWereMovedAway) {
  Levels levels = Levels::of_text("0101");
  const Levels taken = std::move(levels);
  EXPECT_EQ(taken.text(), "0101");
  levels.clear();  // NOLINT(bugprone-use-after-move): by contract
  EXPECT_TRUE(levels.empty());
  EXPECT_EQ(levels.window(0), ~std::uint64_t{0});
  levels.append(0b001, 3);
  EXPECT_EQ(levels.text(), "100");
}

TEST(Levels, FlipBehindTheEndIsABrokenInvariant) {
  Levels levels;
  levels.append(0, 1);
  levels.flip(0);
  EXPECT_EQ(levels.text(), "1");
  EXPECT_ANY_THROW(levels.flip(1));
}

TEST(Waveform, LevelsBeginWhereTheirNumberSaysAndNotWhereErrorsAddUp) {
  Waveform wave{kStart, 187'500, {}};
  wave.levels.append_fill(false, 3'000'000);
  EXPECT_EQ(wave.time_of(1), kStart + 5'333'333 * kPicosecond);
  EXPECT_EQ(wave.time_of(3), kStart + 16 * kMicrosecond);
  EXPECT_EQ(wave.end(), kStart + 16 * kernel::kSecond);
}

TEST(Waveform, TellsTheLevelAtAnInstant) {
  Waveform wave{kStart + 10 * kMicrosecond, 500'000, {}};
  wave.levels.append(0b101, 3);
  EXPECT_TRUE(wave.at(kStart));
  EXPECT_TRUE(wave.at(kStart + 10 * kMicrosecond));
  EXPECT_TRUE(wave.at(kStart + 12 * kMicrosecond - kPicosecond));
  EXPECT_FALSE(wave.at(kStart + 12 * kMicrosecond));
  EXPECT_FALSE(wave.at(kStart + 14 * kMicrosecond - kPicosecond));
  EXPECT_TRUE(wave.at(kStart + 14 * kMicrosecond));
  EXPECT_TRUE(wave.at(kStart + 100 * kMicrosecond));
}

RC_GTEST_PROP(WaveformProperty, FirstLevelAtIsTheInverseOfTimeOf, ()) {
  const auto rate = *rc::gen::inRange<std::int64_t>(1, 50'000'000);
  const auto count = *rc::gen::inRange<std::size_t>(1, 500);
  Waveform wave{kStart + 7 * kPicosecond, rate, {}};
  wave.levels.append_fill(false, count);
  const auto n = *rc::gen::inRange<std::size_t>(0, count + 1);
  RC_ASSERT(wave.first_level_at(wave.time_of(n)) == n);
  RC_ASSERT(wave.first_level_at(wave.time_of(n) + kPicosecond) == std::min(n + 1, count));
}

RC_GTEST_PROP(Levels, RangesAreWhatTheirLevelsAreOneByOne, (const std::vector<bool>& bits)) {
  const Levels levels = levels_of(bits);
  const auto first = *rc::gen::inRange<std::size_t>(0, bits.size() + 1);
  const auto end = *rc::gen::inRange<std::size_t>(first, bits.size() + 1);
  const bool value = *rc::gen::arbitrary<bool>();
  Levels filled = levels;
  filled.fill(first, end, value);
  Levels inverted = levels;
  inverted.invert(first, end);
  for (std::size_t n = 0; n < bits.size(); ++n) {
    const bool is_inside = n >= first && n < end;
    RC_ASSERT(filled[n] == (is_inside ? value : bits[n]));
    RC_ASSERT(inverted[n] == (is_inside ? !bits[n] : bits[n]));
  }
  RC_ASSERT(inverted.size() == bits.size());
  if (first < bits.size()) {
    std::size_t until = first;
    while (until < bits.size() && bits[until] == bits[first]) ++until;
    RC_ASSERT(levels.end_of_run(first) == until);
  }
}

}  // namespace
}  // namespace fieldproof::line
