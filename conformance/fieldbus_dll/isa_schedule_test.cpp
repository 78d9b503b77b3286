// Subject: the cases of schedules, where what they rest on is lost on the line.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "conformance/fieldbus_dll/suite.hpp"

namespace fieldproof::conformance {
namespace {

TEST(IsaSchedule, AReturnedTokenThatIsLostIsNoTokenThatWasReceived) {
  const auto suite = fieldbus_dll_suite();
  const auto one = std::ranges::find(
      suite->cases(), "fieldbus_dll/isa_las/schedule/a_token_that_comes_back_is_not_waited_for",
      &TestCase::id);
  ASSERT_NE(one, suite->cases().end());
  conformance::Setup setup;
  setup.volume = Volume::quick;
  EXPECT_EQ(suite->run(*one, setup).result.verdict, judge::Verdict::pass);
  const auto plan =
      std::filesystem::path(testing::TempDir()) / ("isa_schedule_" + std::to_string(getpid()) + ".json");
  std::ofstream(plan) << R"({"rules": [{"when": {"receiver": "station/in"}, "effect": {"drop": {}}}]})";
  setup.plan_file = plan.string();
  const judge::CaseResult result = suite->run(*one, setup).result;
  std::filesystem::remove(plan);
  EXPECT_EQ(result.verdict, judge::Verdict::fail);
  EXPECT_EQ(result.reason, "next_too_late");
}

}  // namespace
}  // namespace fieldproof::conformance
