// Subject: settings that a sequence begins with, of all roles.
#include "conformance/sequence_settings.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/sequence_check.hpp"
#include "conformance/sequence_draw.hpp"
#include "conformance/sequence_shrink.hpp"
#include "conformance/token_bus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "harness/kernel/sanitized.hpp"
#include "protocols/token_bus/station_settings.hpp"

namespace fieldproof::conformance {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const std::vector<std::unique_ptr<Suite>>& all_suites() {
  static const std::vector<std::unique_ptr<Suite>> suites = [] {
    std::vector<std::unique_ptr<Suite>> made;
    made.push_back(valve_bus_suite());
    made.push_back(interbus_suite());
    made.push_back(fieldbus_dll_suite());
    made.push_back(token_bus_suite());
    return made;
  }();
  return suites;
}

// What the reference is accused of with these settings, in some sequences.
std::string accusation(const Suite& suite, const SequenceRole& role, const field::Settings& settings,
                       std::uint64_t count) {
  const SequenceSource source(role.vocabulary, 5);
  for (std::uint64_t n = 0; n < count; ++n) {
    // Long ones, and an empty one.
    Sequence sequence = source.draw(n * 25);
    sequence.settings = settings;
    const Outcome outcome = run_sequence(suite, role, sequence, {});
    if (outcome.result.verdict >= judge::Verdict::fail)
      return fmt::format("{} with {}: {}, {}", role.test_case.id, settings_text(settings, role.vocabulary),
                         outcome.result.reason, outcome.result.findings.front().actual);
  }
  return {};
}

TEST(SequenceSettings, NoEndOfASettingAccusesAReference) {
  for (const auto& suite : all_suites()) {
    for (const SequenceRole& role : suite->sequence_roles()) {
      ASSERT_FALSE(role.vocabulary.settings.empty()) << role.test_case.id;
      kernel::FewerIfSanitized few(5);
      for (const SequenceSetting& setting : role.vocabulary.settings) {
        for (const std::int64_t value : setting.likely) {
          if (few.leaves_out()) continue;
          const field::Settings settings{{setting.name, value}};
          if (role.vocabulary.objection_to(settings)) continue;
          EXPECT_EQ(accusation(*suite, role, settings, kernel::kIsSanitized ? 1 : 4), "");
        }
      }
    }
  }
}

void expect_within(const SequenceVocabulary& vocabulary, const field::Settings& drawn) {
  EXPECT_FALSE(vocabulary.objection_to(drawn));
  for (const auto& [name, value] : drawn) {
    const SequenceSetting* setting = vocabulary.find_setting(name);
    ASSERT_NE(setting, nullptr) << name;
    EXPECT_GE(value, setting->least) << name;
    EXPECT_LE(value, setting->most) << name;
    EXPECT_NE(value, setting->simple) << name;
  }
}

// Each third sequence that begins with no situation has some, mostly one; the ends come often, what the role
// objects to never, and the commands are those that come without any.
TEST(SequenceSettings, AreDrawnWithinTheVocabularyMostlyAtItsEnds) {
  kernel::FewerIfSanitized few(3);
  for (const auto& suite : all_suites()) {
    for (const SequenceRole& role : suite->sequence_roles()) {
      if (few.leaves_out()) continue;
      SequenceVocabulary without = role.vocabulary;
      without.settings.clear();
      SequenceVocabulary anywhere = role.vocabulary;
      anywhere.situations.clear();
      const SequenceSource source(anywhere, 3);
      const SequenceSource of_all(role.vocabulary, 3);
      const SequenceSource plain(without, 3);
      unsigned set = 0, several = 0, likely = 0;
      std::set<std::string> names;
      for (std::uint64_t n = 0; n < 1'500; ++n) {
        const field::Settings drawn = source.draw(n).settings;
        const Sequence of_any = of_all.draw(n);
        EXPECT_TRUE(n % 100 != 0 || of_any.commands == plain.draw(n).commands) << n;
        expect_within(role.vocabulary, of_any.settings);
        expect_within(role.vocabulary, drawn);
        set += drawn.empty() ? 0U : 1U;
        several += drawn.size() > 1 ? 1U : 0U;
        for (const auto& [name, value] : drawn) names.insert(name);
        if (drawn.size() == 1) {
          const auto& ends = role.vocabulary.find_setting(drawn.front().first)->likely;
          likely += std::ranges::count(ends, drawn.front().second) > 0 ? 1U : 0U;
        }
      }
      EXPECT_GT(set, 200U) << role.test_case.id;
      EXPECT_LT(set, 600U) << role.test_case.id;
      EXPECT_LT(several, set / 2) << role.test_case.id;
      EXPECT_GT(likely, (set - several) / 2) << role.test_case.id;
      // One may be objected to but for some values of another.
      EXPECT_GE(names.size() + 1, role.vocabulary.settings.size()) << role.test_case.id;
    }
  }
}

const SequenceRole& node_with_settings() {
  return all_suites().front()->sequence_roles().front();
}

TEST(SequenceSettings, WhatIsObjectedToIsLeftOut) {
  const SequenceVocabulary& node = node_with_settings().vocabulary;
  const auto place = [&](std::string_view name) {
    return static_cast<std::size_t>(node.find_setting(name) - node.settings.data());
  };
  // As it is anyway; twice, the first counts; shorter than a write takes.
  const std::vector<SettingChoice> chosen{
      {place("loss_limit"), 0}, {place("boards"), 1}, {place("boards"), 2}, {place("loss_limit"), 1}};
  EXPECT_EQ(settings_of(chosen, node), (field::Settings{{"boards", 1}}));
  EXPECT_THAT(node.objection_to({{"loss_limit", 1}}).value_or(""), HasSubstr("can be judged from"));
  EXPECT_FALSE(node.objection_to({{"boards", 1}}));
}

// Whoever declares a number has it in each sequence.
TEST(SequenceSettings, WhatAPicsDeclaresIsNotDrawn) {
  const Suite& suite = *all_suites().front();
  conformance::Setup setup;
  setup.pics.emplace().declare("boards", std::int64_t{1});
  const SequenceVocabulary tied = suite.vocabulary(node_with_settings(), setup);
  EXPECT_EQ(tied.find_setting("boards"), nullptr);
  EXPECT_NE(tied.find_setting("loss_limit"), nullptr);
  EXPECT_EQ(tied.settings.size() + 1, node_with_settings().vocabulary.settings.size());
}

// Two of three are needed, one of them from 700 on; three commands of which one is.
TEST(SequenceSettings, ShrinkToTheFewestAndTheNearestToTheirDefaults) {
  const SequenceVocabulary& node = node_with_settings().vocabulary;
  const auto value = [](const Sequence& sequence, std::string_view name) -> std::optional<std::int64_t> {
    const auto found = std::ranges::find(sequence.settings, name, &field::Settings::value_type::first);
    return found == sequence.settings.end() ? std::nullopt : std::optional(found->second);
  };
  const std::int64_t rate = node.find_setting("bit_rate")->simple;
  const SequenceFails fails = [&](const Sequence& sequence) {
    return value(sequence, "bit_rate").value_or(rate) <= rate - 700 && value(sequence, "boards") == 1 &&
           !sequence.commands.empty();
  };
  Sequence sequence = SequenceSource(node, 2).draw(150);
  sequence.settings = {{"bit_rate", 1'200}, {"answers_writes", 1}, {"boards", 1}};
  ASSERT_GT(sequence.commands.size(), 1U);
  const Sequence smallest = shrunk(sequence, node, fails);
  EXPECT_EQ(smallest.settings, (field::Settings{{"bit_rate", rate - 700}, {"boards", 1}}));
  EXPECT_EQ(smallest.commands.size(), 1U);
}

TEST(SequenceSettings, HaveTheElementsOfAListOfAFixedSize) {
  const token_bus::StationConfiguration as_made;
  const auto all = settings_of_elements(token_bus::kStationTable, &as_made, "target_rotation_octets");
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[1].name, "target_rotation_octets_1");
  EXPECT_EQ(all[1].simple, 40'000);
  EXPECT_EQ(all[1].least, 0);
  EXPECT_EQ(all[1].most, 2'097'151);
  EXPECT_THAT(all[1].likely, testing::IsSupersetOf({std::int64_t{0}, std::int64_t{2'097'151}}));
  token_bus::StationConfiguration given;
  field::take_settings(token_bus::kStationTable, {{all[1].name, 7}}, given);
  EXPECT_EQ(given.rules.target_rotation_octets[1], 7U);
}

TEST(SequenceSettings, AreReadInWordsAndNamedByAFinding) {
  const SequenceVocabulary& node = node_with_settings().vocabulary;
  const Sequence sequence{{}, {{"loss_limit", 0}, {"boards", 1}}};
  EXPECT_EQ(sequence_lines(sequence, node).front(), "settings loss_limit valves hold, boards 1");
}

}  // namespace
}  // namespace fieldproof::conformance
