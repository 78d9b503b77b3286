#include "protocols/token_bus/line_code.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "protocols/token_bus/frame.hpp"

namespace fieldproof::token_bus {
namespace {

constexpr std::int64_t kPhyRate = 10'000'000;
constexpr std::size_t kPreambleSymbols = 32;

line::Waveform wave_of(std::string_view phy_bits) {
  line::Waveform wave{{}, 2 * kPhyRate, {}};
  PhySymbols symbols;
  for (const char bit : phy_bits)
    symbols.push_back(bit == '1' ? PhySymbol::cd1 : bit == '0' ? PhySymbol::cd0 : PhySymbol::idl);
  append(wave.levels, symbols);
  return wave;
}

std::string indicated(const line::Waveform& wave) {
  MacSymbols symbols;
  for (const Indication& one : indications_in(wave, kPhyRate)) symbols.push_back(one.symbol);
  return written(symbols);
}

std::string repeated(std::string_view text, std::size_t times) {
  std::string all;
  for (std::size_t n = 0; n < times; ++n) all += text;
  return all;
}

TEST(LineCode, EncodesEachSymbolAsTheTableOfThePaper) {
  EXPECT_EQ(written(phy_symbols_of(mac_symbols_of("S"))), "II");
  EXPECT_EQ(written(phy_symbols_of(mac_symbols_of("PP"))), "1010");
  EXPECT_EQ(written(phy_symbols_of(mac_symbols_of("0"))), "01");
  EXPECT_EQ(written(phy_symbols_of(mac_symbols_of("1"))), "10");
  EXPECT_EQ(written(phy_symbols_of(mac_symbols_of("NN"))), "1100");
  EXPECT_EQ(written(phy_symbols_of(start_delimiter())), "1100011100010101");
  EXPECT_EQ(written(phy_symbols_of(end_delimiter(false, false))), "1100101100100101");
  EXPECT_EQ(written(phy_symbols_of(end_delimiter(true, true))), "1100101100101010");
}

TEST(LineCode, HalfBitsAreThoseOfIeee8023) {
  // CD1 rises in its middle, CD0 falls, idle is high.
  EXPECT_EQ(half_bits_of(mac_symbols_of("10S")).text(),
            "01101001"
            "1111");
}

TEST(LineCode, ThePreambleAndTheFirstNonDataAreTheStartOfA8023Frame) {
  MacSymbols symbols;
  append_framed(symbols, {}, {});
  const std::string bits = written(phy_symbols_of(symbols));
  EXPECT_EQ(bits.substr(2, 64), repeated("10", 28) + "10101011");
}

TEST(MacDecoder, PairsAreIndicatedByCarrierAndSignal) {
  struct Row {
    std::string_view pair;
    std::string_view fine;  // CARRIER_ON, no SIGNAL_ERROR, no non_data before
    std::string_view after_non_data;
  };
  for (const Row& row : {Row{"10", "1", "B"}, Row{"01", "0", "B"}, Row{"11", "N", "B"}, Row{"00", "B", "N"},
                         Row{"II", "S", "S"}, Row{"1I", "B", "B"}, Row{"0I", "B", "B"}, Row{"I1", "S", "S"},
                         Row{"I0", "S", "S"}}) {
    const auto taken = [&](bool has_non_data, LineStatus status) {
      MacDecoder decoder;
      if (has_non_data) {
        decoder.take(PhySymbol::cd1);
        decoder.take(PhySymbol::cd1);
      }
      const auto bit = [](char letter) {
        return letter == '1' ? PhySymbol::cd1 : letter == '0' ? PhySymbol::cd0 : PhySymbol::idl;
      };
      EXPECT_FALSE(decoder.take(bit(row.pair[0]), status).has_value());
      return written(MacSymbols{decoder.take(bit(row.pair[1]), status).value()});
    };
    EXPECT_EQ(taken(false, {}), row.fine) << row.pair;
    EXPECT_EQ(taken(true, {}), row.after_non_data) << row.pair;
    EXPECT_EQ(taken(false, {.has_signal_error = true}), "B") << row.pair;
    EXPECT_EQ(taken(true, {.has_signal_error = true}), "B") << row.pair;
    EXPECT_EQ(taken(false, {.has_carrier = false}), "S") << row.pair;
    EXPECT_EQ(taken(true, {.has_carrier = false, .has_signal_error = true}), "S") << row.pair;
  }
}

TEST(MacDecoder, APreambleThatIsReadOneBitLateIsSlippedOnce) {
  const std::string content = "NN0NN0001011";
  const PhySymbols bits = phy_symbols_of(mac_symbols_of("PPPPPPPP" + content));
  for (const bool is_late : {false, true}) {
    MacDecoder decoder;
    MacSymbols symbols;
    for (std::size_t n = is_late ? 1 : 0; n < bits.size(); ++n) {
      if (const auto symbol = decoder.take(bits[n])) symbols.push_back(*symbol);
    }
    EXPECT_EQ(decoder.slips(), is_late ? 1U : 0U);
    const std::string text = written(symbols);
    EXPECT_EQ(text.substr(text.size() - content.size()), content);
  }
}

TEST(MacDecoder, ABitTooManyAfterTheLastFrameIsSilence) {
  const std::string frame = repeated("10", kPreambleSymbols) + "1100011100010101" + repeated("0110", 20);
  EXPECT_EQ(indicated(wave_of(frame + "1100101100100101"
                                      "1I"))
                .back(),
            'S');
  EXPECT_EQ(indicated(wave_of(frame + "1100101100100101"
                                      "1I"))
                .find('B'),
            std::string::npos);
  // With I = 1 more is due, and it is cut.
  EXPECT_NE(indicated(wave_of(frame + "1100101100101001"
                                      "1I"))
                .find('B'),
            std::string::npos);
}

RC_GTEST_PROP(LineCodeProperties, WhatIsRequestedIsIndicated, (const std::vector<std::uint8_t>& octets)) {
  MacSymbols symbols;
  append_framed(symbols, octets, {});
  const line::Waveform wave{{}, 2 * kPhyRate, half_bits_of(symbols)};
  std::string requested = written(symbols);
  for (char& letter : requested) letter = letter == 'P' ? '1' : letter;
  RC_ASSERT(indicated(wave).starts_with(requested));
}

// Repeaters and receivers eat the front of a transmission.
RC_GTEST_PROP(LineCodeProperties, AFrontThatIsLostLeavesWhatFollowsThePreamble,
              (const std::vector<std::uint8_t>& octets)) {
  const auto lost = *rc::gen::inRange<std::size_t>(0, 2 * 2 * 24);
  MacSymbols symbols;
  append_framed(symbols, octets, {});
  const line::Levels all = half_bits_of(symbols);
  const line::Waveform wave{{}, 2 * kPhyRate, all.slice(lost, all.size() - lost)};
  const std::string content = written(std::span(symbols).subspan(kPreambleSymbols));
  RC_ASSERT(indicated(wave).find(content) != std::string::npos);
}

RC_GTEST_PROP(LineCodeProperties, AnyLevelsAreDecoded, (std::vector<bool> levels)) {
  line::Waveform wave{{}, 2 * kPhyRate, {}};
  for (const bool level : levels) wave.levels.append(level ? 1 : 0, 1);
  const auto indications = indications_in(wave, kPhyRate);
  for (const Indication& one : indications) RC_ASSERT(one.symbol != MacSymbol::pad_idle);
  RC_ASSERT(indications.back().symbol != MacSymbol::one);
}

}  // namespace
}  // namespace fieldproof::token_bus
