// Subject: the slave suite at other positions of the ring and on other stations than its own network has.
// What it says about the reference and about each mutant at the first position is the subject of
// suite_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "conformance/interbus/slave_mutants.hpp"
#include "conformance/interbus/whole_cases.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

// The program has stresses, and a test of its own for the cases that need them.
const std::vector<SlaveCase>& cases_without_stress() {
  static const std::vector<SlaveCase> cases = [] {
    std::vector<SlaveCase> chosen = slave_cases();
    std::erase_if(chosen, [](const SlaveCase& one) { return has_tag(one.test_case, kStressTag); });
    return chosen;
  }();
  return cases;
}

SlaveSetting setting_for(const conformance::Setup& setup) {
  SlaveSetting setting;
  setting.seed = setup.seed;
  setting.volume = setup.volume;
  for (const Assignment& assignment : setup.implementations) {
    if (!assignment.uri.starts_with("mutant:")) continue;
    setting.make_device = [name =
                               assignment.uri.substr(8)](const interbus::SlaveConfiguration& configuration) {
      return slave_mutants().make(name, configuration);
    };
  }
  return setting;
}

std::string what_failed(const judge::CaseResult& result) {
  std::string text(judge::name(result.verdict));
  text += " " + result.reason;
  for (const judge::Finding& finding : result.findings) {
    for (const std::string& expected : finding.expected) text += "\n  expected " + expected;
    text += "\n  actual   " + finding.actual + "\n  at       " + finding.first_difference;
    for (const std::string& line : finding.decode) text += "\n    " + line;
  }
  return text;
}

void expect_reference_passes(const SlaveSetting& setting) {
  for (const SlaveCase& slave_case : cases_without_stress()) {
    if (is_canary(slave_case.test_case)) continue;
    const judge::CaseResult result = run_whole(slave_case, setting);
    EXPECT_EQ(result.verdict, judge::Verdict::pass)
        << slave_case.test_case.id << " seed " << setting.seed << ": " << what_failed(result);
  }
}

TEST(SlaveSuite, NoFalseAlarmAtOtherPositions) {
  for (kernel::FewerIfSanitized few(4);
       const auto& [position, stations] : {std::pair{2, 3}, {1, 2}, {3, 3}, {5, 8}}) {
    if (few.leaves_out()) continue;
    for (std::uint64_t seed = 1; seed <= (kernel::kIsSanitized ? 1 : 5); ++seed) {
      SlaveSetting setting;
      setting.seed = seed;
      setting.volume = Volume::quick;
      setting.position = position;
      setting.stations = stations;
      expect_reference_passes(setting);
      if (HasFailure()) return;
    }
  }
}

// Behind a station the sequences for it pass, for a reason that is not known yet.
constexpr std::string_view kAtTheFirstPositionOnly = "forgets_the_missing_stop_of_a_begin";

TEST(SlaveSuite, EachMutantIsCaughtAtAnotherPosition) {
  kernel::FewerIfSanitized few(8);
  for (const SlaveCase& slave_case : cases_without_stress()) {
    if (has_tag(slave_case.test_case, kStressTag))
      continue;  // the program has stresses, and a test of its own
    for (const MustCatch& declared : slave_case.test_case.catches) {
      if (few.leaves_out() || declared.mutant == kAtTheFirstPositionOnly) continue;
      SlaveSetting setting = setting_for({});
      setting.volume = Volume::quick;
      setting.position = 2;
      setting.stations = 3;
      setting.make_device = [&](const interbus::SlaveConfiguration& configuration) {
        return slave_mutants().make(declared.mutant, configuration);
      };
      const judge::CaseResult result = run_whole(slave_case, setting);
      EXPECT_EQ(result.verdict, judge::Verdict::fail) << slave_case.test_case.id << " " << declared.mutant;
      // Of many sequences another one may be the first that shows it.
      if (slave_case.families) continue;
      EXPECT_EQ(result.reason, declared.reason) << slave_case.test_case.id << " " << declared.mutant;
    }
  }
}

// What stands in an answer and could not be verified: a finding about it never rests on a verified source.
TEST(SlaveSuite, FindingsAboutUnverifiedCodingsSaySo) {
  const std::set<std::string> unverified = {"check_wrong",     "status_word_wrong", "header_wrong",
                                            "message_missing", "error_not_marked",  "mark_of_others_cleared"};
  std::set<std::string> met;
  for (const SlaveCase& slave_case : cases_without_stress()) {
    const TestCase& test_case = slave_case.test_case;
    for (const MustCatch& declared : test_case.catches) {
      if (!unverified.contains(declared.reason)) continue;
      met.insert(declared.reason);
      EXPECT_FALSE(judge::is_verified(test_case.reference_of(declared.reason).standing))
          << test_case.id << " " << declared.reason;
      EXPECT_FALSE(judge::is_verified(test_case.rests_on().standing)) << test_case.id;
    }
  }
  EXPECT_GE(met.size(), 4U);
}

TEST(SlaveSuite, EachDetailIsOneThatACaseCanFailFor) {
  // Reasons of expectations that many cases share, which no mutant has to prove in each of them.
  const std::set<std::string> shared = {"check_wrong", "status_word_wrong", "header_wrong"};
  for (const SlaveCase& slave_case : cases_without_stress()) {
    const TestCase& test_case = slave_case.test_case;
    for (const PartialSource& detail : test_case.details) {
      const bool is_proven = std::ranges::any_of(detail.reasons, [&](const std::string& reason) {
        return shared.contains(reason) ||
               std::ranges::any_of(test_case.catches, [&](const MustCatch& c) { return c.reason == reason; });
      });
      EXPECT_TRUE(is_proven) << test_case.id << " " << detail.reasons.front();
    }
  }
}

TEST(SlaveSuite, ACaseOfAVerifiedSourceMayFailForAnUnverifiedOne) {
  for (const SlaveCase& slave_case : cases_without_stress()) {
    if (slave_case.test_case.purpose != "IS-10") continue;
    EXPECT_TRUE(judge::is_verified(slave_case.test_case.reference.standing));
    SlaveSetting setting = setting_for({});
    setting.volume = Volume::quick;
    const auto result_with = [&](const char* mutant) {
      setting.make_device = [mutant](const interbus::SlaveConfiguration& configuration) {
        return slave_mutants().make(mutant, configuration);
      };
      return run_whole(slave_case, setting);
    };
    EXPECT_EQ(result_with("does_not_mark_status").findings.at(0).reference.standing, judge::Standing::own);
    EXPECT_EQ(result_with("tells_no_check_error").reference.standing, judge::Standing::own);
    EXPECT_EQ(result_with("latches_in_spite_of_own_error").reference.standing, judge::Standing::searched);
  }
}

// A network of one station with one word in the directions that the ID code says.
SlaveSetting setting_with_id_code(std::uint16_t id_code) {
  interbus::NetworkDescription network;
  network.name = "one station";
  network.stations.emplace_back();
  network.stations.back().name = "station";
  network.stations.back().id_code = id_code;
  SlaveSetting setting;
  setting.volume = Volume::quick;
  setting.network = network;
  return setting;
}

TEST(SlaveSuite, StationsOfOneDirectionPassWhatAppliesToThem) {
  for (const std::uint16_t id_code : std::initializer_list<std::uint16_t>{0x0201, 0x0101, 0x0202}) {
    std::map<judge::Verdict, int> verdicts;
    for (const SlaveCase& slave_case : cases_without_stress()) {
      if (is_canary(slave_case.test_case)) continue;
      const judge::CaseResult result = run_whole(slave_case, setting_with_id_code(id_code));
      ++verdicts[result.verdict];
      EXPECT_TRUE(result.verdict == judge::Verdict::pass || result.verdict == judge::Verdict::not_applicable)
          << std::hex << id_code << " " << slave_case.test_case.id << ": " << what_failed(result);
    }
    EXPECT_GT(verdicts[judge::Verdict::pass], 20) << std::hex << id_code;
  }
}

// What such a station sends where others have their inputs is its own affair.
TEST(SlaveSuite, TheRegisterOfAnOutputStationIsNotJudged) {
  int judged = 0;
  for (const SlaveCase& slave_case : cases_without_stress()) {
    if (is_canary(slave_case.test_case)) continue;
    SlaveSetting setting = setting_with_id_code(0x0201);
    setting.make_device = [](const interbus::SlaveConfiguration& configuration) {
      return slave_mutants().make("input_bit_stuck", configuration);
    };
    const judge::CaseResult result = run_whole(slave_case, setting);
    if (result.verdict == judge::Verdict::not_applicable) continue;
    ++judged;
    EXPECT_EQ(result.verdict, judge::Verdict::pass) << slave_case.test_case.id << ": " << what_failed(result);
  }
  EXPECT_GT(judged, 20);
}

TEST(SlaveSuite, TheCanaryFails) {
  for (const SlaveCase& slave_case : cases_without_stress()) {
    if (!is_canary(slave_case.test_case)) continue;
    EXPECT_EQ(run_whole(slave_case, {}).verdict, judge::Verdict::fail);
  }
}

TEST(SlaveSuite, EveryTestPurposeHasACaseAndEveryMutantAMutant) {
  std::set<std::string> purposes;
  std::set<std::string> ids;
  for (const SlaveCase& slave_case : cases_without_stress()) {
    const TestCase& test_case = slave_case.test_case;
    purposes.insert(test_case.purpose);
    EXPECT_TRUE(ids.insert(test_case.id).second) << test_case.id;
    EXPECT_EQ(test_case.role(), "slave") << test_case.id;
    for (const std::string* text : {&test_case.requirement, &test_case.stimulus, &test_case.expected})
      EXPECT_FALSE(text->empty()) << test_case.id;
  }
  for (unsigned n = 1; n <= 42; ++n) {
    const std::string number = n < 10 ? "0" + std::to_string(n) : std::to_string(n);
    EXPECT_TRUE(purposes.contains("IS-" + number)) << "IS-" << number;
  }
  std::set<std::string> mutants;
  for (const Mutant& mutant : slave_mutants().mutants()) mutants.insert(mutant.label);
  for (unsigned n = 1; n <= 22; ++n) EXPECT_TRUE(mutants.contains("MS" + std::to_string(n))) << "MS" << n;
}

TEST(SlaveSuite, UnknownMutantNamesItsNeighbours) {
  try {
    slave_mutants().make("crc_preset_zer", {});
    FAIL();
  } catch (const kernel::Error& error) {
    EXPECT_NE(std::string(error.what()).find("crc_preset_zero"), std::string::npos);
  }
}

}  // namespace
}  // namespace fieldproof::conformance
