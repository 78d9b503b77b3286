#include "protocols/valve_bus/codec.hpp"
#include "harness/field/facts.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fieldproof::valve_bus {
namespace {

using Octets = std::vector<std::uint8_t>;

Octets written(const Command& command) {
  const auto octets = octets_of(command);
  return {octets.begin(), octets.end()};
}
Octets written(const Response& response) {
  const auto octets = octets_of(response);
  return {octets.begin(), octets.end()};
}

Rules with(CharacterProfile profile) {
  Rules rules;
  rules.characters = profile;
  return rules;
}

// Worked by hand from the paper's rule for the block check.
TEST(ValveBusFrame, HasThePublishedBlockCheck) {
  EXPECT_EQ(written(Command{0x05, 0x00, 0xA5, 0x3C}), (Octets{0x05, 0x00, 0xA5, 0x3C, 0x9C}));
  EXPECT_EQ(written(Command{0x63, 0x01, 0x00, 0x00}), (Octets{0x63, 0x01, 0x00, 0x00, 0x62}));
  EXPECT_EQ(written(Command{0x01, 0x00, 0xFF, 0x00}), (Octets{0x01, 0x00, 0xFF, 0x00, 0xFE}));
  EXPECT_EQ(written(Response{0xF0, 0x0F}), (Octets{0xF0, 0x0F, 0xFF}));
  EXPECT_EQ(written(Response{0x55, 0x55}), (Octets{0x55, 0x55, 0x00}));
  EXPECT_EQ(written(Response{}), (Octets{0x00, 0x00, 0x00}));
}

TEST(ValveBusFrame, IsToldInWords) {
  EXPECT_EQ(describe(Command{5, 0, 0xA5, 0x3C}), "write 05: A5 3C");
  EXPECT_EQ(describe(Command{0x63, 1, 7, 7}), "read 63");
  EXPECT_EQ(describe(Command{5, 9, 1, 2}), "command 09 of 05: 01 02");
  EXPECT_EQ(describe(Response{0xF0, 0x0F}), "response F0 0F");
}

TEST(ValveBusRules, HaveTheTimesOfEachCharacterFormat) {
  const Rules rules;  // 11 bits at 375 kbit/s
  EXPECT_EQ(kernel::describe(character_time(rules)), "29.333333 us");
  EXPECT_EQ(kernel::describe(longest_gap(rules)), "44.000 us");
  EXPECT_EQ(kernel::describe(delimiter(rules)), "102.666667 us");
  Rules short_characters = with(CharacterProfile::eight_bits);
  short_characters.bit_rate = 100'000;
  EXPECT_EQ(kernel::describe(character_time(short_characters)), "100.000 us");
  EXPECT_EQ(kernel::describe(delimiter(short_characters)), "350.000 us");
}

TEST(ValveBusRules, NameTheSourceOfEachNumber) {
  Rules changed;
  changed.read_attempts = 4;
  for (const field::Fact& fact : field::facts_of(kRulesTable, changed)) {
    EXPECT_FALSE(fact.source.empty()) << fact.name;
    if (fact.name == "last_address") {
      EXPECT_EQ(fact.standing, judge::Standing::seed);
    }
    if (fact.name == "read_attempts") {
      EXPECT_EQ(fact.value, "4");
      EXPECT_EQ(fact.source, "set for this run; not from a source");
    }
  }
}

TEST(ValveBusCodec, SendsTheNinthBitAsOneAndIgnoresIt) {
  CharacterCodec codec{Rules{}};
  line::Waveform wave;
  wave.rate = Rules{}.bit_rate;
  codec.append(wave.levels, Octets{0x5A});
  EXPECT_TRUE(wave.levels[9]);
  wave.levels.flip(9);
  unsigned characters = 0;
  codec.decode(wave, [&](const line::UartCharacter& character) {
    ++characters;
    EXPECT_EQ(character.octet(), 0x5A);
    EXPECT_TRUE(character.is_good());
  });
  EXPECT_EQ(characters, 1U);
}

TEST(ValveBusCodec, FramesAreDelimitedByThreeAndAHalfCharacters) {
  const line::InterCharacterGaps of_bus = gaps(Rules{});
  EXPECT_EQ(kernel::describe(of_bus.longest), "44.000 us");
  EXPECT_EQ(kernel::describe(of_bus.delimiter), "102.666667 us");
  EXPECT_EQ(kernel::describe(of_bus.notice), "32.000 us");
}

TEST(ValveBusCodec, KeepsEightOctetsOfAFrameAndCountsAll) {
  FrameCollector collector{Rules{}};
  for (unsigned n = 0; n < 9; ++n) collector.add({.data = static_cast<std::uint16_t>(n)});
  EXPECT_EQ(collector.frame().count, 9U);
  EXPECT_EQ(collector.frame().octets.size(), 8U);
  EXPECT_FALSE(collector.frame().whole(5));
  EXPECT_FALSE(collector.frame().whole(9));
}

}  // namespace
}  // namespace fieldproof::valve_bus
