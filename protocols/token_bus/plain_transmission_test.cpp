#include "protocols/token_bus/plain_transmission.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "protocols/token_bus/frame.hpp"

namespace fieldproof::token_bus {
namespace {

constexpr std::int64_t kHalfBitRate = 20'000'000;

line::Levels written_frame(const Octets& octets, const Delimiting& delimiting) {
  MacSymbols symbols;
  append_framed(symbols, octets, delimiting);
  return half_bits_of(symbols);
}

TEST(PlainTransmission, IsReadWithItsFlags) {
  const Octets octets{0x10, 0x04, 0x00, 0x0A, 0x00, 0x42, 0x1F, 0x4F, 0xD3};
  for (const bool more_follows : {false, true}) {
    for (const bool has_error : {false, true}) {
      const auto plain = plain_transmission_in(
          written_frame(octets, {.more_follows = more_follows, .has_error = has_error}));
      ASSERT_TRUE(plain.has_value());
      EXPECT_EQ(plain->octets, octets);
      EXPECT_EQ(plain->more_follows, more_follows);
      EXPECT_EQ(plain->has_error, has_error);
      EXPECT_EQ(plain->first_half_bit, 4U * 32U);
    }
  }
  EXPECT_FALSE(plain_transmission_in({}).has_value());
  EXPECT_FALSE(plain_transmission_in(written_frame(octets, {.preamble_octets = 0})).has_value());
}

// What somebody made of a transmission on its way: whoever reads it octet by octet reads what the decoder
// does.
RC_GTEST_PROP(PlainTransmissionProperties, WhatIsPlainIsWhatTheDecoderReads, (const Octets& octets)) {
  const Delimiting delimiting{.preamble_octets = *rc::gen::inRange(0U, 6U),
                              .more_follows = *rc::gen::arbitrary<bool>(),
                              .has_error = *rc::gen::arbitrary<bool>()};
  line::Levels levels = written_frame(*rc::gen::element(octets, with_check(octets)), delimiting);
  const auto flips = *rc::gen::inRange(0U, 4U);
  for (unsigned n = 0; n < flips && !levels.empty(); ++n)
    levels.flip(*rc::gen::inRange<std::size_t>(0, levels.size()));
  const auto cut = *rc::gen::element<std::size_t>(0, 0, 1, 2, 3, 4, 8, 32);
  levels = levels.slice(std::min(cut, levels.size()), levels.size() - std::min(cut, levels.size()));
  levels.append(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::element(0U, 0U, 1U, 4U, 32U));
  const line::Waveform wave{{}, kHalfBitRate, std::move(levels)};

  const FrameReader reader{Rules{}};
  const auto at_once = reader.read(wave);
  const auto bit_by_bit = reader.read(indications_in(wave, Rules{}.phy_bit_rate));
  RC_ASSERT(at_once.size() == bit_by_bit.size());
  for (std::size_t n = 0; n < at_once.size(); ++n) {
    RC_ASSERT(at_once[n].kind == bit_by_bit[n].kind);
    RC_ASSERT(at_once[n].octets == bit_by_bit[n].octets);
    RC_ASSERT(at_once[n].more_follows == bit_by_bit[n].more_follows);
    RC_ASSERT(at_once[n].first_half_bit == bit_by_bit[n].first_half_bit);
    RC_ASSERT(at_once[n].end_half_bit == bit_by_bit[n].end_half_bit);
  }
}

}  // namespace
}  // namespace fieldproof::token_bus
