#include "protocols/interbus/rules.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "harness/field/facts.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::interbus {
namespace {

using judge::Standing;

// In the order of Rules. The structured binding counts the members: a new one without a fact does not
// compile.
std::vector<std::string_view> members() {
  const Rules rules;
  const auto& [bit_rate, telegram, telegram_gap_millibits, status_pitch_bits, forward_delay_half_bits,
               return_delay_half_bits, local_delay_half_bits, cable_delay_ps_per_m, loopback_word,
               frame_check, status_clean, status_marked, end_telegrams, software_time, silence_limit,
               silence_tolerance, latch_limit, stop_after_bad_cycles, quality_bad_cycles,
               quality_window_cycles, published_recovery_cycles, max_stations, max_io_points, max_levels,
               max_distance_m, max_cable_m, control_remote_off, control_local_off, control_reset,
               control_acknowledge, message_reconfiguration, message_check_error, message_peripheral_fault,
               length_codes] = rules;
  static_cast<void>(bit_rate);
  return {"bit_rate",
          "telegram",
          "telegram_gap_millibits",
          "status_pitch_bits",
          "forward_delay_half_bits",
          "return_delay_half_bits",
          "local_delay_half_bits",
          "cable_delay_ps_per_m",
          "loopback_word",
          "frame_check",
          "status_clean",
          "status_marked",
          "end_telegrams",
          "software_time",
          "silence_limit",
          "silence_tolerance",
          "latch_limit",
          "stop_after_bad_cycles",
          "quality_bad_cycles",
          "quality_window_cycles",
          "published_recovery_cycles",
          "max_stations",
          "max_io_points",
          "max_levels",
          "max_distance_m",
          "max_cable_m",
          "control_remote_off",
          "control_local_off",
          "control_reset",
          "control_acknowledge",
          "message_reconfiguration",
          "message_check_error",
          "message_peripheral_fault",
          "length_codes"};
}

const field::Fact& fact_about(const std::vector<field::Fact>& table, std::string_view member) {
  return *std::find_if(table.begin(), table.end(),
                       [&](const field::Fact& fact) { return fact.is_about(member); });
}

std::string table_text() {
  std::string text = "| Rule | Value | Source | Standing |\n|---|---|---|---|\n";
  for (const field::Fact& fact : field::facts_of(kRulesTable, Rules{})) {
    text += fmt::format("| `{}` | {} | {} | {} |\n", fact.name, fact.value, fact.source,
                        judge::name(fact.standing));
  }
  return text;
}

TEST(FactsTest, EveryMemberHasItsFactsInOrder) {
  std::vector<std::string> found;
  for (const field::Fact& fact : field::facts_of(kRulesTable, Rules{})) {
    const std::string member = fact.name.substr(0, fact.name.find('['));
    if (found.empty() || found.back() != member) found.push_back(member);
    EXPECT_FALSE(fact.value.empty()) << fact.name;
    EXPECT_FALSE(fact.source.empty()) << fact.name;
  }
  const auto all = members();
  EXPECT_EQ(found, std::vector<std::string>(all.begin(), all.end()));
}

TEST(FactsTest, ReadmeHoldsTheTableOfTheCode) {
  std::ifstream file(FIELDPROOF_SOURCE_DIR "/protocols/interbus/README.md");
  const std::string readme((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_NE(readme.find("\n" + table_text() + "\n"), std::string::npos)
      << "the table of protocols/interbus/README.md must read:\n"
      << table_text();
}

TEST(FactsTest, WhatCannotBeVerifiedIsNotCalledVerified) {
  const auto table = field::facts_of(kRulesTable, Rules{});
  for (const std::string_view member :
       {"telegram", "loopback_word", "status_clean", "status_marked", "control_remote_off",
        "control_local_off", "control_reset", "control_acknowledge", "message_reconfiguration",
        "message_check_error", "message_peripheral_fault", "quality_bad_cycles", "stop_after_bad_cycles",
        "latch_limit"}) {
    EXPECT_FALSE(judge::is_verified(fact_about(table, member).standing)) << member;
  }
  for (const std::string_view member : {"bit_rate", "end_telegrams", "software_time", "silence_limit",
                                        "max_stations", "max_io_points", "length_codes"}) {
    EXPECT_TRUE(judge::is_verified(fact_about(table, member).standing)) << member;
  }
}

TEST(FactsTest, ChangedValueLosesItsSource) {
  Rules rules;
  rules.silence_limit = 250 * kernel::kMillisecond;
  const auto table = field::facts_of(kRulesTable, rules);
  EXPECT_EQ(fact_about(table, "silence_limit").value, "250.000 ms");
  EXPECT_EQ(fact_about(table, "silence_limit").standing, Standing::own);
  EXPECT_EQ(fact_about(table, "bit_rate").standing, Standing::seed);
}

TEST(FactsTest, OtherPublishedValuesKeepTheirSource) {
  Rules rules;
  rules.bit_rate = 2'000'000;
  rules.max_distance_m = 150;
  rules.end_telegrams = 2;
  rules.software_time = 700 * kernel::kMicrosecond;
  const auto table = field::facts_of(kRulesTable, rules);
  EXPECT_EQ(fact_about(table, "bit_rate").standing, Standing::searched);
  EXPECT_EQ(fact_about(table, "max_distance_m").standing, Standing::searched);
  EXPECT_EQ(fact_about(table, "end_telegrams").standing, Standing::seed);
  EXPECT_EQ(fact_about(table, "software_time").standing, Standing::seed);
}

TEST(FactsTest, ReplacedLengthTableHasNoSource) {
  Rules rules;
  rules.length_codes = {{1, 1}, {2, 2}};
  EXPECT_EQ(fact_about(field::facts_of(kRulesTable, rules), "length_codes").standing, Standing::own);
}

TEST(LengthCodesTest, EveryCodeAndEveryLengthOnce) {
  std::set<unsigned> codes;
  std::set<unsigned> words;
  for (const LengthCode& entry : published_length_codes()) {
    EXPECT_TRUE(codes.insert(entry.code).second) << unsigned{entry.code};
    EXPECT_TRUE(words.insert(entry.words).second) << unsigned{entry.words};
  }
  EXPECT_EQ(words, (std::set<unsigned>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 24, 26, 32}));
  for (const unsigned undefined : {0x08U, 0x09U, 0x0AU, 0x0BU, 0x0CU, 0x0DU, 0x10U, 0x18U, 0x1FU}) {
    EXPECT_FALSE(codes.contains(undefined)) << undefined;
  }
}

TEST(RulesTest, FrameCheckIsTheOneOfTheTable) {
  const line::FrameCheckParameters* parameters = line::find_frame_check(Rules{}.frame_check);
  ASSERT_NE(parameters, nullptr);
  EXPECT_EQ(parameters->width, 16U);
  EXPECT_TRUE(parameters->poly == 0x1021 && parameters->init == 0xFFFF && parameters->xorout == 0);
  EXPECT_TRUE(parameters->check == 0x29B1);
}

TEST(RulesTest, LoopbackWordIsNeitherStuckNorALegalStart) {
  const Rules rules;
  EXPECT_NE(rules.loopback_word, 0x0000);
  EXPECT_NE(rules.loopback_word, 0xFFFF);
}

}  // namespace
}  // namespace fieldproof::interbus
