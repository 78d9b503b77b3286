// Subject: conformance/detection: how soon sequences find each mutant of a role.
#include "conformance/detection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "conformance/valve_bus/node_sequence.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

DetectionTable nodes_detected(std::uint64_t commands, unsigned jobs) {
  static const auto suite = valve_bus_suite();
  return detect_mutants({.suite = suite.get(),
                         .role = &node_sequence_role(),
                         .setup = {},
                         .seeds = 2,
                         .most_commands = commands,
                         .jobs = jobs});
}

TEST(Detection, CountsCommandsUpToTheTriggerAndTheFinding) {
  const DetectionTable table = nodes_detected(kernel::kIsSanitized ? 30 : 120, 1);
  EXPECT_EQ(table.role, "valve_bus/node");
  EXPECT_TRUE(table.is_complete);
  EXPECT_TRUE(table.false_alarms.empty());
  EXPECT_GT(table.found(), table.pairs() / 10);
  for (const MutantDetections& mutant : table.mutants) {
    ASSERT_EQ(mutant.by_seed.size(), table.seeds);
    for (const Detection& one : mutant.by_seed) {
      EXPECT_LE(one.found.value_or(0), one.commands);
      EXPECT_EQ(one.reason.empty(), !one.found) << mutant.mutant->name;
      // What is found does something else than the reference.
      EXPECT_LE(one.triggered.value_or(0), one.found.value_or(one.commands)) << mutant.mutant->name;
    }
  }
}

TEST(Detection, IsTheSameForAnyNumberOfJobs) {
  const DetectionTable alone = nodes_detected(30, 1);
  const DetectionTable together = nodes_detected(30, 2);
  ASSERT_EQ(alone.mutants.size(), together.mutants.size());
  for (std::size_t m = 0; m < alone.mutants.size(); ++m) {
    for (std::size_t n = 0; n < alone.seeds; ++n) {
      const Detection& a = alone.mutants[m].by_seed[n];
      const Detection& b = together.mutants[m].by_seed[n];
      EXPECT_EQ(std::tie(a.triggered, a.found, a.commands, a.reason),
                std::tie(b.triggered, b.found, b.commands, b.reason))
          << alone.mutants[m].mutant->name;
    }
  }
}

TEST(Detection, FewCommandsFindLessAndSayWhichCaseFindsIt) {
  const DetectionTable few = nodes_detected(3, 1);
  EXPECT_LT(few.found(), few.pairs());
  const bool names_a_case = std::ranges::any_of(few.mutants, [](const MutantDetections& one) {
    return !one.by_seed.front().found && one.suite_catch.starts_with("valve_bus/node/");
  });
  EXPECT_TRUE(names_a_case);
}

}  // namespace
}  // namespace fieldproof::conformance
