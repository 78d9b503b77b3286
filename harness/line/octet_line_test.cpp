#include "harness/line/octet_line.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>

namespace fieldproof::line {
namespace {

RC_GTEST_PROP(OctetLine, WhatIsSentComesBack, (const std::vector<std::uint8_t>& octets)) {
  OctetLine line(19'200);
  RC_ASSERT(line.octets_in(line.wave_of(octets, kernel::kStart)) == octets);
}

TEST(OctetLine, AWrongCharacterSpoilsTheTransmission) {
  OctetLine line(9'600, {.data_bits = 8, .parity = Parity::even});
  Waveform wave = line.wave_of(std::array<std::uint8_t, 2>{0x12, 0x34}, kernel::kStart);
  wave.levels.flip(3);
  EXPECT_EQ(line.octets_in(wave), std::nullopt);
}

}  // namespace
}  // namespace fieldproof::line
