#include "conformance/valve_bus/driven_line.hpp"

#include <gtest/gtest.h>

#include "protocols/valve_bus/codec.hpp"

namespace fieldproof::conformance {
namespace {

// A driver may come on at any time from a bit before the start bit on; what is driven idle ends with the last
// whole piece.
TEST(DrivenLine, IdleThatEndsALittleBeforeTheStartBitIsTheSameTransmission) {
  const valve_bus::Rules rules;
  const kernel::Duration bit = valve_bus::bits(rules, 1);
  for (const std::int64_t hundredths : {0, 3, 6, 10, 40}) {
    DrivenLine line(character_format(rules), rules.bit_rate);
    line::Waveform idle;
    idle.start = kernel::kStart;
    idle.rate = rules.bit_rate;
    idle.levels.append_idle(1);
    line.on_wave(idle);
    line::Waveform character;
    character.start = idle.end() + bit * hundredths / 100;
    character.rate = rules.bit_rate;
    const std::uint8_t octet = 0x5A;
    valve_bus::CharacterCodec(rules).append(character.levels, std::span(&octet, 1));
    line.on_wave(character);
    const auto all = line.transmissions();
    EXPECT_EQ(all.size(), hundredths <= 6 ? 1U : 2U) << hundredths;
    ASSERT_EQ(all.back().characters.size(), 1U);
    EXPECT_EQ(all.back().characters.front().octet(), octet);
    EXPECT_EQ(all.back().characters.front().start, character.start);
  }
}

}  // namespace
}  // namespace fieldproof::conformance
