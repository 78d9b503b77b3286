#include "protocols/token_bus/frame.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "protocols/token_bus/rules_table.hpp"

namespace fieldproof::token_bus {
namespace {

line::Waveform wave_of(std::span<const std::uint8_t> octets, const Delimiting& delimiting = {}) {
  MacSymbols symbols;
  append_framed(symbols, octets, delimiting);
  return {{}, 2 * Rules{}.phy_bit_rate, half_bits_of(symbols)};
}

std::vector<ReceptionKind> kinds(const line::Waveform& wave, const Rules& rules = {}) {
  std::vector<ReceptionKind> all;
  for (const Reception& one : FrameReader(rules).read(wave)) all.push_back(one.kind);
  return all;
}
using Kinds = std::vector<ReceptionKind>;

struct FrameSample {
  Frame frame;
  Octets on_line;
};

TEST(FrameSamples, AreWrittenAndReadAsComputedElsewhere) {
  const Rules rules;
  using enum FrameKind;
  const std::vector<FrameSample> samples{
      {{.kind = token, .destination = 0x0004, .source = 0x000A},
       {0x10, 0x04, 0x00, 0x0A, 0x00, 0x42, 0x1F, 0x4F, 0xD3}},
      {{.kind = set_successor, .destination = 0x000A, .source = 0x0006, .data = {0x06, 0x00}},
       {0x30, 0x0A, 0x00, 0x06, 0x00, 0x06, 0x00, 0x10, 0xA1, 0xA5, 0xE7}},
      {{.kind = solicit_successor_1, .destination = 0x0004, .source = 0x000A},
       {0x80, 0x04, 0x00, 0x0A, 0x00, 0x52, 0x38, 0x49, 0x02}},
      {{.kind = who_follows, .destination = 0x0004, .source = 0x000A, .data = {0x04, 0x00}},
       {0xC0, 0x04, 0x00, 0x0A, 0x00, 0x04, 0x00, 0x83, 0x27, 0x31, 0xC1}}};
  for (const auto& [frame, on_line] : samples) {
    EXPECT_EQ(with_check(octets_of(frame, rules)), on_line) << describe(frame, rules);
    const auto receptions = FrameReader(rules).read({{}, 2 * rules.phy_bit_rate, levels_of(frame, rules)});
    ASSERT_EQ(receptions.size(), 1U);
    EXPECT_EQ(receptions[0].kind, ReceptionKind::frame);
    EXPECT_EQ(frame_of(receptions[0].octets, rules), frame) << describe(frame, rules);
  }
}

TEST(FrameSamples, TheBitsOfATokenOnTheLine) {
  const Rules rules;
  MacSymbols symbols;
  append_framed(symbols, with_check(octets_of(Frame{.destination = 4, .source = 0x0A}, rules)), {});
  const std::string bits = written(phy_symbols_of(symbols));
  ASSERT_EQ(bits.size(), 240U);
  std::string preamble;
  for (unsigned n = 0; n < 32; ++n) preamble += "10";
  // SD, then control 00001000 in the order of the line.
  EXPECT_TRUE(bits.starts_with(preamble + "1100011100010101"
                                          "0101010110010101"));
  EXPECT_TRUE(bits.ends_with("1100101100100101"));
}

TEST(FrameTime, OfATokenIsAsComputed) {
  Rules rules;
  EXPECT_EQ(frame_time(rules, 0), 24 * kernel::kMicrosecond);
  rules.address_length = AddressLength::bits_48;
  EXPECT_EQ(frame_time(rules, 0), 36'800 * kernel::kNanosecond);
  EXPECT_EQ(most_data(rules), 8'174U);
  rules.address_length = AddressLength::bits_16;
  EXPECT_EQ(most_data(rules), 8'182U);
  EXPECT_EQ(frame_octets(rules, 0), 9U);
  EXPECT_EQ(contest_passes(rules), 9U);
  // The longest frame: 13.1 ms.
  EXPECT_EQ(frame_time(rules, most_data(rules)), octets(rules, 8'197));
}

TEST(ControlCodes, AreThoseOfTheTable) {
  struct Row {
    Frame frame;
    std::uint8_t stored;
    std::uint8_t code;
  };
  using enum FrameKind;
  for (const Row& row :
       {Row{{.kind = claim_token}, 0x00, 0x00}, Row{{.kind = solicit_successor_1}, 0x80, 0x01},
        Row{{.kind = solicit_successor_2}, 0x40, 0x02}, Row{{.kind = who_follows}, 0xC0, 0x03},
        Row{{.kind = resolve_contention}, 0x20, 0x04}, Row{{.kind = token}, 0x10, 0x08},
        Row{{.kind = set_successor}, 0x30, 0x0C},
        Row{{.kind = data, .action = Action::request_with_no_response, .priority = 6}, 0x62, 0x46},
        Row{{.kind = data, .priority = 4}, 0x22, 0x44}, Row{{.kind = data, .priority = 0}, 0x02, 0x40},
        Row{{.kind = data, .action = Action::response, .priority = 7}, 0xEA, 0x57},
        Row{{.kind = management_data, .priority = 6}, 0x61, 0x86}}) {
    EXPECT_EQ(control_octet(row.frame), row.stored);
    EXPECT_EQ(code_of(row.stored), row.code);
  }
}

TEST(Addresses, AreNumbersWithTheFirstBitLowest) {
  Rules rules;
  rules.address_length = AddressLength::bits_48;
  const Octets octets{0xF0, 0x2E, 0x15, 0x6C, 0x77, 0x9B};
  EXPECT_EQ(address_of(octets), 0x9B77'6C15'2EF0U);
  EXPECT_EQ(octets_of(Address{0x9B77'6C15'2EF0}, rules), octets);
  EXPECT_EQ(broadcast(rules), 0xFFFF'FFFF'FFFFU);
  EXPECT_TRUE(is_group(broadcast(rules)));
  EXPECT_FALSE(is_group(0x000A));
}

TEST(FrameOf, RefusesWhatIsNoFrame) {
  const Rules rules;
  const Octets good = octets_of(Frame{.destination = 4, .source = 0x0A}, rules);
  ASSERT_TRUE(frame_of(good, rules).has_value());
  for (unsigned control = 0; control < 256; ++control) {
    Octets octets = good;
    octets[0] = static_cast<std::uint8_t>(control);
    const unsigned code = code_of(octets[0]);
    const bool is_data = (code >> 6 == 1 || code >> 6 == 2) && (code >> 3 & 7) <= 2;
    // who_follows and set_successor have no data unit here.
    const bool is_control = code == 0 || code == 1 || code == 2 || code == 4 || code == 8;
    EXPECT_EQ(frame_of(octets, rules).has_value(), is_data || is_control) << code;
  }
  Octets from_group = good;
  from_group[3] |= 1;
  EXPECT_FALSE(frame_of(from_group, rules).has_value());
  Octets of_other_length = good;
  of_other_length.resize(13);
  EXPECT_FALSE(frame_of(of_other_length, rules).has_value());
  EXPECT_FALSE(frame_of(std::span(good).first(4), rules).has_value());
  EXPECT_FALSE(frame_of({}, rules).has_value());
}

TEST(FrameReader, TellsTheErrorsOfReceptionApart) {
  const Rules rules;
  const Octets good = with_check(octets_of(Frame{.destination = 4, .source = 0x0A}, rules));
  EXPECT_EQ(kinds(wave_of(good)), Kinds{ReceptionKind::frame});
  Octets wrong = good;
  wrong[2] ^= 4;
  EXPECT_EQ(kinds(wave_of(wrong)), Kinds{ReceptionKind::fcs_error});
  EXPECT_EQ(kinds(wave_of(good, {.has_error = true})), Kinds{ReceptionKind::e_bit_error});
  EXPECT_EQ(kinds(wave_of(wrong, {.has_error = true})), Kinds{ReceptionKind::e_bit_error});
  EXPECT_EQ(kinds(wave_of({})), Kinds{ReceptionKind::fragment});
  EXPECT_EQ(kinds(wave_of(with_check({}))), Kinds{ReceptionKind::fragment});
  EXPECT_EQ(kinds({{}, 20'000'000, line::Levels::of_text("0110011001100110")}),
            Kinds{ReceptionKind::non_silence});
}

TEST(FrameReader, CutsAndBitsTooManyAreFragments) {
  const Rules rules;
  const Octets good = with_check(octets_of(Frame{.destination = 4, .source = 0x0A}, rules));
  MacSymbols symbols;
  append_framed(symbols, good, {});
  for (std::size_t cut = 40; cut < symbols.size(); ++cut) {
    const std::span<const MacSymbol> front = std::span(symbols).first(cut);
    EXPECT_EQ(kinds({{}, 20'000'000, half_bits_of(front)}), Kinds{ReceptionKind::fragment}) << cut;
  }
  for (unsigned more = 1; more < 8; ++more) {
    MacSymbols longer = symbols;
    longer.insert(longer.end() - 8, more, MacSymbol::zero);
    EXPECT_EQ(kinds({{}, 20'000'000, half_bits_of(longer)}), Kinds{ReceptionKind::fragment}) << more;
  }
}

TEST(FrameReader, TheLongestFrameIsOneAndALongerOneIsNot) {
  Rules rules;
  for (const unsigned most : {64U, 8'191U}) {
    rules.most_octets = most;
    Octets content = octets_of(Frame{.kind = FrameKind::data, .destination = 4, .source = 0x0A}, rules);
    content.resize(most - kCheckOctets, 0xA5);
    EXPECT_EQ(kinds(wave_of(with_check(content)), rules), Kinds{ReceptionKind::frame});
    content.push_back(0xA5);
    EXPECT_EQ(kinds(wave_of(with_check(content)), rules), Kinds{ReceptionKind::too_long});
  }
}

TEST(FrameReader, FramesFollowEachOtherInOneTransmission) {
  const Rules rules;
  const Octets first =
      with_check(octets_of(Frame{.kind = FrameKind::data, .destination = 4, .source = 10}, rules));
  const Octets second = with_check(octets_of(Frame{.destination = 4, .source = 10}, rules));
  MacSymbols symbols;
  append_framed(symbols, first, {.more_follows = true});
  append_framed(symbols, second, {.preamble_octets = 2});
  const auto receptions = FrameReader(rules).read({{}, 20'000'000, half_bits_of(symbols)});
  ASSERT_EQ(receptions.size(), 2U);
  EXPECT_TRUE(receptions[0].more_follows);
  EXPECT_EQ(receptions[0].kind, ReceptionKind::frame);
  EXPECT_FALSE(receptions[1].more_follows);
  EXPECT_EQ(receptions[1].kind, ReceptionKind::frame);
  EXPECT_LT(receptions[0].end_half_bit, receptions[1].first_half_bit);
  // A start delimiter in the place of an end.
  MacSymbols again;
  append_framed(again, first, {});
  again.resize(again.size() - 8);
  append_framed(again, second, {.preamble_octets = 0});
  EXPECT_EQ(kinds({{}, 20'000'000, half_bits_of(again)}),
            (Kinds{ReceptionKind::fragment, ReceptionKind::frame}));
}

RC_GTEST_PROP(FrameProperties, WhatIsWrittenIsRead, (const Octets& octets, bool has_long_addresses)) {
  Rules rules;
  rules.address_length = has_long_addresses ? AddressLength::bits_48 : AddressLength::bits_16;
  const Address all = broadcast(rules);
  const Frame frame{.kind = *rc::gen::element(FrameKind::data, FrameKind::management_data),
                    .action = static_cast<Action>(*rc::gen::inRange(0, 3)),
                    .priority = *rc::gen::inRange(0U, 8U),
                    .destination = *rc::gen::arbitrary<Address>() & all,
                    .source = *rc::gen::arbitrary<Address>() & all & ~Address{1},
                    .data = octets};
  const auto receptions = FrameReader(rules).read({{}, 20'000'000, levels_of(frame, rules)});
  RC_ASSERT(receptions.size() == 1U);
  RC_ASSERT(receptions[0].kind == ReceptionKind::frame);
  RC_ASSERT(frame_of(receptions[0].octets, rules) == frame);
}

RC_GTEST_PROP(FrameProperties, AFlippedHalfBitLeavesNoOtherFrame, ()) {
  const Rules rules;
  const Frame frame{.destination = 4, .source = 0x0A};
  line::Waveform wave{{}, 20'000'000, levels_of(frame, rules)};
  wave.levels.flip(*rc::gen::inRange<std::size_t>(0, wave.levels.size()));
  for (const Reception& one : FrameReader(rules).read(wave)) {
    if (one.kind == ReceptionKind::frame) RC_ASSERT(frame_of(one.octets, rules) == frame);
  }
}

RC_GTEST_PROP(FrameProperties, AnyLevelsHaveAClass, (const std::vector<bool>& levels)) {
  line::Waveform wave{{}, 20'000'000, {}};
  for (const bool level : levels) wave.levels.append(level ? 1 : 0, 1);
  RC_ASSERT(!FrameReader(Rules{}).read(wave).empty());
}

TEST(TokenBusRules, ReferencesArePossibleAndLimitsAreNamed) {
  EXPECT_EQ(impossible(Rules{}), std::nullopt);
  Rules rules;
  rules.slot_time_octets = 1'363;
  EXPECT_EQ(impossible(rules), "slot_time_octets is 1363, and may be 12 to 1362");
  rules.slot_time_octets = 1'362;
  EXPECT_EQ(impossible(rules), std::nullopt);
  rules.most_octets = 64;
  EXPECT_NE(impossible(rules), std::nullopt);
  rules = {};
  rules.response_gap_octets = 27;
  EXPECT_NE(impossible(rules), std::nullopt);
}

TEST(TokenBusRules, DefaultsAreThoseOfThePages) {
  const Rules rules;
  EXPECT_EQ(rules.preamble_octets, 4U);
  EXPECT_EQ(rules.slot_time_octets, 28U);
  EXPECT_EQ(rules.most_octets, 8'191U);
  EXPECT_EQ(rules.bus_idle_slots, 7U);
  EXPECT_EQ(rules.lowest_bus_idle_slots, 6U);
  EXPECT_EQ(rules.response_gap_octets, 6U);
  EXPECT_EQ(rules.blanking_symbols, 28U);
  EXPECT_EQ(octets(rules, 1), 1'600 * kernel::kNanosecond);
}

}  // namespace
}  // namespace fieldproof::token_bus
