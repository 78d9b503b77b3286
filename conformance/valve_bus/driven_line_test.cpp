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

TEST(DrivenLine, AFrameWhoseCheckFitsIsSaidInWords) {
  const valve_bus::Rules rules;
  using Octets = std::vector<std::uint8_t>;
  EXPECT_EQ(octets_in_words(Octets{0x22, 0x01, 0x00, 0x00, 0x23}, rules), "22 01 00 00 23, read of node 34");
  EXPECT_EQ(octets_in_words(Octets{0x01, 0x00, 0x45, 0x5D, 0x19}, rules),
            "01 00 45 5D 19, write 45 5D to node 1");
  EXPECT_EQ(octets_in_words(Octets{0x01, 0x07, 0x45, 0x5D, 0x1E}, rules),
            "01 07 45 5D 1E, command 7 with 45 5D to node 1");
  EXPECT_EQ(octets_in_words(Octets{0x45, 0x5D, 0x18}, rules), "45 5D 18, response 45 5D");
  EXPECT_EQ(octets_in_words(Octets{0x01, 0x00, 0x45, 0x5D, 0x18}, rules), "01 00 45 5D 18");
  EXPECT_EQ(characters_text({}, rules), "no character");
}

}  // namespace
}  // namespace fieldproof::conformance
