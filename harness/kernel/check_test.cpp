#include "harness/kernel/check.hpp"

#include <gtest/gtest.h>

#include <string>
#include <thread>

namespace fieldproof::kernel {
namespace {

std::string text_of_failing_check() {
  try {
    FIELDPROOF_CHECK(1 + 1 == 3, "arithmetic has changed");
  } catch (const BrokenInvariant& broken) {
    return broken.what();
  }
  return "nothing was thrown";
}

TEST(Check, SaysWhereWhatAndWhichExpression) {
  const std::string text = text_of_failing_check();
  EXPECT_TRUE(text.starts_with("harness/kernel/check_test.cpp:")) << text;
  EXPECT_NE(text.find("arithmetic has changed (1 + 1 == 3 does not hold)"), std::string::npos) << text;
}

TEST(Check, HasNoContextOutsideOfOne) {
  EXPECT_TRUE(text_of_failing_check().ends_with("does not hold)"));
}

TEST(Check, PassesSilentlyAndEvaluatesOnce) {
  int evaluations = 0;
  FIELDPROOF_CHECK(++evaluations == 1, "the condition is evaluated once");
  EXPECT_EQ(evaluations, 1);
}

TEST(Check, DoesNotComposeTheSentenceWhileTheConditionHolds) {
  int composed = 0;
  const auto sentence = [&composed] {
    ++composed;
    return std::string("never needed");
  };
  FIELDPROOF_CHECK(true, sentence());
  EXPECT_EQ(composed, 0);
}

TEST(CheckContext, NestsOutermostFirstAndEndsWithItsScope) {
  const CheckContext outer([] { return std::string("case a/b, seed 7"); });
  {
    const CheckContext inner([] { return std::string("at 12 us"); });
    EXPECT_TRUE(text_of_failing_check().ends_with("[case a/b, seed 7; at 12 us]")) << text_of_failing_check();
  }
  EXPECT_TRUE(text_of_failing_check().ends_with("[case a/b, seed 7]")) << text_of_failing_check();
}

TEST(CheckContext, DescribesTheMomentOfTheFailure) {
  int now = 1;
  const CheckContext context([&now] { return "at " + std::to_string(now); });
  now = 2;
  EXPECT_EQ(CheckContext::describe_all(), "at 2");
}

TEST(CheckContextThreads, BelongsToItsThread) {
  const CheckContext mine([] { return std::string("mine"); });
  std::string seen = "not looked";
  std::thread([&seen] { seen = CheckContext::describe_all(); }).join();
  EXPECT_EQ(seen, "");
  EXPECT_EQ(CheckContext::describe_all(), "mine");
}

}  // namespace
}  // namespace fieldproof::kernel
