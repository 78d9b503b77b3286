// Subject: what a finding shows of its bench, for a reader who does not know the defect.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/runner.hpp"
#include "conformance/token_bus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"

namespace fieldproof::conformance {
namespace {

using testing::HasSubstr;

// Of the first finding of a case against a mutant: what was expected and seen, and the lines of evidence.
std::string first_finding(const Suite& suite, const std::string& id, const std::string& mutant) {
  for (const TestCase& one : suite.cases()) {
    if (one.id != id) continue;
    Setup setup;
    setup.volume = Volume::quick;
    setup.implementations = {{one.role(), 0, "mutant:" + mutant}};
    const judge::CaseResult result = run_case({&suite, &one}, setup).outcome.result;
    if (result.findings.empty()) return "no finding";
    const judge::Finding& finding = result.findings.front();
    return fmt::format("{}\n{}\n{}\n{}\n{}", fmt::join(finding.expected, "\n"), finding.actual, finding.step,
                       finding.first_difference, fmt::join(finding.decode, "\n"));
  }
  return "no such case";
}

TEST(FindingEvidence, HasWhatTestersDroveIntoASide) {
  const auto suite = token_bus_suite();
  const std::string text =
      first_finding(*suite, "token_bus/translator/locking/what_moves_and_what_holds_the_phase",
                    "zeros_need_not_be_in_a_row");
  EXPECT_THAT(text, testing::ContainsRegex("tester drove translator/receive at [0-9.]+ [mun]s: [01I]+"));
  EXPECT_THAT(text, HasSubstr("the translator sent: nothing"));
}

TEST(FindingEvidence, HasTheLossOfSupplyAmongTheFrames) {
  const auto suite = token_bus_suite();
  EXPECT_THAT(first_finding(*suite, "token_bus/station/supply/waiting_data_are_gone", "queues_kept"),
              HasSubstr("the supply returned at "));
  const auto valves = valve_bus_suite();
  EXPECT_THAT(
      first_finding(*valves, "valve_bus/host/memory/nothing_survives_power", "old_data_survive_power"),
      HasSubstr("the supply went at "));
}

TEST(FindingEvidence, HasWhatACycleSuffered) {
  const auto suite = interbus_suite();
  EXPECT_THAT(first_finding(*suite, "interbus/master/rejection/damaged_loopback_word_is_rejected",
                            "loopback_not_compared"),
              HasSubstr(", with a check that fits"));
  EXPECT_THAT(first_finding(*suite, "interbus/master/rejection/displaced_loopback_word_is_rejected",
                            "ring_longer_by_an_octet_accepted"),
              HasSubstr("the register 8 bits longer"));
}

TEST(FindingEvidence, SaysOnceWhatCameManyTimes) {
  const auto suite = interbus_suite();
  const std::string text =
      first_finding(*suite, "interbus/slave/compared/many_errors", "counts_errors_in_8_bits");
  EXPECT_THAT(text, HasSubstr(" times data "));
  EXPECT_LT(text.size(), 5'000U);
}

TEST(FindingEvidence, SaysThatALineWasSilent) {
  const auto suite = fieldbus_dll_suite();
  const std::string text =
      first_finding(*suite, "fieldbus_dll/ff_las/schedule/each_item_has_its_time", "standby_tail_ignored");
  EXPECT_THAT(text, HasSubstr("nothing was driven by anybody"));
}

}  // namespace
}  // namespace fieldproof::conformance
