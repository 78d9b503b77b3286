#include "conformance/valve_bus/suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conformance/answer_pairs.hpp"
#include "conformance/false_alarms.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

TEST(ValveBusSuite, ReferencesPassInManySeedsWithoutAFalseAlarm) {
  const auto suite = valve_bus_suite();
  for (std::uint64_t seed = 1; seed <= many_seeds(); ++seed) {
    EXPECT_THAT(false_alarms(*suite, seed), testing::IsEmpty());
  }
  if (kernel::kIsSanitized) return;
  // Here two pitches of a scan come out alike at first sight.
  EXPECT_THAT(false_alarms(*suite, 1019), testing::IsEmpty());
  EXPECT_THAT(false_alarms(*suite, 1094), testing::IsEmpty());
}

TEST(ValveBusSuite, NoTwoAnswersOfAPicsAccuseAReference) {
  const auto suite = valve_bus_suite();
  const std::vector<AnswerPairs> roles = pairs_of_answers(*suite, kernel::kIsSanitized ? 40 : 1);
  ASSERT_EQ(roles.size(), 2U);
  for (const AnswerPairs& one : roles) {
    EXPECT_THAT(one.accused, testing::IsEmpty()) << one.role;
    EXPECT_THAT(one.left_open, testing::IsEmpty()) << one.role;
    EXPECT_GT(one.declarations, 0U) << one.role;
    EXPECT_LT(one.refused, one.pairs / 2) << one.role;
    RecordProperty(one.role, std::to_string(one.declarations) + " declarations of " +
                                 std::to_string(one.pairs) + " pairs");
  }
}

// Who reads a finding sees what the implementation was given.
TEST(ValveBusSuite, AFailureNamesTheSettingsThatAreNotTheUsualOnes) {
  const auto suite = valve_bus_suite();
  const auto settings_of_failures = [&](const judge::Pics& pics) {
    conformance::Setup setup;
    setup.volume = Volume::quick;
    setup.pics = pics;
    setup.implementations = {{"node", 0, "mutant:answers_twice"}};
    for (const TestCase& one : suite->cases()) {
      if (one.id == "valve_bus/node/read/is_answered") return suite->run(one, setup).result.settings;
    }
    return std::vector<std::string>{"no such case"};
  };
  judge::Pics pics;
  pics.declare("boards", std::int64_t{1});
  EXPECT_THAT(settings_of_failures(pics), testing::Contains("boards 1 in place of 2"));
}

// Each position of the switches is a bit rate; refreshes come within exchanges at the lowest.
TEST(ValveBusSuite, NoBitRateAccusesTheHost) {
  const auto suite = valve_bus_suite();
  for (kernel::FewerIfSanitized few(4); const std::int64_t dip : {1, 2, 3, 4, 5, 6, 7}) {
    if (few.leaves_out()) continue;
    conformance::Setup setup;
    setup.volume = Volume::quick;
    setup.pics.emplace().declare("dip", dip);
    const auto is_accused = [](judge::Verdict verdict) { return verdict >= judge::Verdict::fail; };
    EXPECT_THAT(cases_where(*suite, setup, is_accused, "host"), testing::IsEmpty()) << dip;
  }
}

}  // namespace
}  // namespace fieldproof::conformance
