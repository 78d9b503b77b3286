#include "protocols/valve_bus/codec.hpp"
#include "harness/field/facts.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
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

constexpr std::array kProfiles = {CharacterProfile::ninth_bit_one, CharacterProfile::even_parity,
                                  CharacterProfile::eight_bits};

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

RC_GTEST_PROP(ValveBusCodec, HearsWhatItWrites, (const Octets& octets)) {
  const Rules rules = with(*rc::gen::elementOf(kProfiles));
  CharacterCodec codec(rules);
  line::Waveform wave;
  wave.rate = rules.bit_rate;
  codec.append(wave.levels, octets);
  Octets heard;
  codec.hear(wave, [&](const HeardCharacter& character) {
    RC_ASSERT(character.is_good());
    RC_ASSERT(character.start == kernel::level_time(wave.start,
                                                    static_cast<std::int64_t>(heard.size()) *
                                                        character_format(rules).half_bits() / 2,
                                                    rules.bit_rate));
    heard.push_back(character.octet());
  });
  RC_ASSERT(heard == octets);
}

TEST(ValveBusCodec, IgnoresTheNinthBitAndRequiresTheStopBit) {
  CharacterCodec codec{Rules{}};
  line::Waveform wave;
  wave.rate = Rules{}.bit_rate;
  codec.append(wave.levels, Octets{0x5A});
  wave.levels.flip(9);
  const auto is_good = [&] {
    bool good = false;
    codec.hear(wave, [&](const HeardCharacter& character) {
      EXPECT_EQ(character.octet(), 0x5A);
      good = character.is_good();
    });
    return good;
  };
  EXPECT_TRUE(is_good());
  wave.levels.flip(10);
  EXPECT_FALSE(is_good());
}

// What is collected of octets whose gaps, in half characters, stand between them.
std::vector<CollectedFrame> collected(const Octets& octets, const std::vector<kernel::Duration>& gaps) {
  const Rules rules;
  FrameCollector collector(rules);
  std::vector<CollectedFrame> frames;
  kernel::Time start{};
  for (std::size_t n = 0; n < octets.size(); ++n) {
    if (collector.ends_at() <= start) {
      frames.push_back(collector.frame());
      collector.clear();
    }
    const kernel::Time end = start + character_time(rules);
    collector.add({.start = start, .busy_until = end, .data = octets[n]});
    start = end + (n < gaps.size() ? gaps[n] : kernel::Duration{});
  }
  if (!collector.is_empty()) frames.push_back(collector.frame());
  return frames;
}

TEST(FrameCollector, TakesGapsOnBothSidesOfEachLimit) {
  const Rules rules;
  const Octets octets{1, 2};
  const auto count_of = [&](kernel::Duration gap) { return collected(octets, {gap}).size(); };
  const auto is_spoilt = [&](kernel::Duration gap) { return collected(octets, {gap}).front().is_spoilt; };
  EXPECT_FALSE(is_spoilt(longest_gap(rules)));
  EXPECT_TRUE(is_spoilt(longest_gap(rules) + kernel::kPicosecond));
  EXPECT_EQ(count_of(delimiter(rules) - kernel::kPicosecond), 1U);
  EXPECT_TRUE(is_spoilt(delimiter(rules) - kernel::kPicosecond));
  EXPECT_EQ(count_of(delimiter(rules)), 2U);
  EXPECT_FALSE(is_spoilt(delimiter(rules)));
}

TEST(FrameCollector, CountsMoreOctetsThanItKeeps) {
  const auto frames = collected(Octets(300, 7), {});
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].count, 300U);
  EXPECT_FALSE(frames[0].whole(5));
}

}  // namespace
}  // namespace fieldproof::valve_bus
