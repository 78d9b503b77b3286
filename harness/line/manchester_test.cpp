#include "harness/line/manchester.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

namespace fieldproof::line {
namespace {

constexpr std::int64_t kManchesterRate = 31'250;

using enum Symbol;

std::vector<Symbol> heard(const Levels& halves, const ManchesterLayout& layout = {}, std::size_t times = 1) {
  Waveform wave;
  wave.rate = 2 * kManchesterRate * static_cast<std::int64_t>(times);
  for (std::size_t n = 0; n < halves.size(); ++n) wave.levels.append_fill(halves[n], times);
  std::vector<Symbol> symbols;
  ManchesterReceiver(layout, kManchesterRate).receive(wave, symbols);
  return symbols;
}

Levels sent(const std::vector<Symbol>& symbols, const ManchesterLayout& layout = {}) {
  Levels levels;
  for (const Symbol symbol : symbols) ManchesterCode(layout).append(levels, symbol);
  return levels;
}

const std::vector<Symbol> kStartDelimiter = {one,  non_data_plus,  non_data_minus, one,
                                             zero, non_data_minus, non_data_plus,  zero};
const std::vector<Symbol> kEndDelimiter = {
    one, non_data_plus, non_data_minus, non_data_plus, non_data_minus, one, zero, one};

// The half bits as an open implementation of WorldFIP (nanoFIP) has them: "10" is 1, "01" is 0, "11" is N+.
TEST(ManchesterCode, WritesTheDelimitersOfTheFieldbus) {
  EXPECT_EQ(sent(kStartDelimiter).text(), "1011001001001101");
  EXPECT_EQ(sent(kEndDelimiter).text(), "1011001100100110");
  Levels preamble;
  ManchesterCode({}).append_octet(preamble, 0xAA);
  EXPECT_EQ(preamble.text(), "1001100110011001");
}

TEST(ManchesterCode, WritesTheOctetsOfEthernetRisingAndFromTheirLowestBit) {
  const ManchesterLayout ethernet{.one_falls = false, .most_significant_first = false};
  Levels levels;
  ManchesterCode(ethernet).append_octet(levels, 0xD5);  // start frame delimiter: 10101011 on the line
  EXPECT_EQ(levels.text(), "0110011001100101");
}

// A device that has the two wires swapped hears no start delimiter in one.
TEST(ManchesterCode, AnInvertedStartDelimiterIsNone) {
  Levels inverted = sent(kStartDelimiter);
  inverted.invert(0, inverted.size());
  EXPECT_EQ(heard(inverted), (std::vector<Symbol>{zero, non_data_minus, non_data_plus, zero, one,
                                                  non_data_plus, non_data_minus, one}));
}

TEST(ManchesterReceiver, GivesNoSymbolForHalfABit) {
  Levels levels = sent({one, zero});
  levels.append(1, 1);
  EXPECT_EQ(heard(levels), (std::vector<Symbol>{one, zero}));
}

// Written so that the quarter points lie in the right level and their neighbours do not.
TEST(ManchesterReceiver, TakesEachHalfInItsMiddle) {
  Waveform wave;
  wave.rate = 16 * kManchesterRate;
  wave.levels.append_fill(false, 16);
  wave.levels.set(4, true);  // the level that begins at a quarter of the bit
  std::vector<Symbol> symbols;
  const ManchesterReceiver receiver({}, kManchesterRate);
  receiver.receive(wave, symbols);
  EXPECT_EQ(symbols, std::vector<Symbol>{one});
  wave.levels.set(4, false);
  wave.levels.set(3, true);
  wave.levels.set(5, true);
  wave.levels.set(12, true);
  symbols.clear();
  receiver.receive(wave, symbols);
  EXPECT_EQ(symbols, std::vector<Symbol>{zero});
}

rc::Gen<std::vector<Symbol>> arbitrary_symbols() {
  return rc::gen::container<std::vector<Symbol>>(rc::gen::element(zero, one, non_data_plus, non_data_minus));
}

RC_GTEST_PROP(ManchesterReceiver, HearsWhatWasSentAtAnyRefinement, ()) {
  const auto symbols = *arbitrary_symbols();
  const ManchesterLayout layout{*rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>()};
  const auto times = *rc::gen::inRange<std::size_t>(1, 40);
  RC_ASSERT(heard(sent(symbols, layout), layout, times) == symbols);
}

// One wrong half bit is always seen: data become no data, and no data become data.
RC_GTEST_PROP(ManchesterReceiver, AWrongHalfBitIsACodeViolation, ()) {
  const auto symbols = *rc::gen::nonEmpty(arbitrary_symbols());
  Levels levels = sent(symbols);
  const auto half = *rc::gen::inRange<std::size_t>(0, levels.size());
  levels.flip(half);
  const auto changed = heard(levels);
  RC_ASSERT(changed.size() == symbols.size());
  for (std::size_t n = 0; n < symbols.size(); ++n) {
    if (n == half / 2) {
      RC_ASSERT(is_data(changed[n]) != is_data(symbols[n]));
    } else {
      RC_ASSERT(changed[n] == symbols[n]);
    }
  }
}

RC_GTEST_PROP(ManchesterCode, OctetsAreTheirBits, (std::uint8_t octet, bool one_falls)) {
  Levels levels;
  ManchesterCode({one_falls, true}).append_octet(levels, octet);
  const auto symbols = heard(levels, {one_falls, true});
  RC_ASSERT(symbols.size() == 8U);
  for (unsigned bit = 0; bit < 8; ++bit) {
    RC_ASSERT(symbols[bit] == ((octet >> (7 - bit) & 1) != 0 ? one : zero));
  }
}

}  // namespace
}  // namespace fieldproof::line
