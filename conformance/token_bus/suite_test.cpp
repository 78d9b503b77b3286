#include "conformance/token_bus/suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conformance/answer_pairs.hpp"
#include "conformance/false_alarms.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

TEST(TokenBusSuite, ReferencesPassInManySeedsWithoutAFalseAlarm) {
  const auto suite = token_bus_suite();
  for (std::uint64_t seed = 1; seed <= many_seeds(); ++seed) {
    EXPECT_THAT(false_alarms(*suite, seed), testing::IsEmpty());
  }
}

TEST(TokenBusSuite, NoTwoAnswersOfAPicsAccuseAReference) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: minutes of the cases that other tests run under sanitizers";
  const auto suite = token_bus_suite();
  const std::vector<AnswerPairs> roles = pairs_of_answers(*suite);
  ASSERT_EQ(roles.size(), 2U);
  for (const AnswerPairs& one : roles) {
    EXPECT_THAT(one.accused, testing::IsEmpty()) << one.role;
    // With some declared times its precondition, a ring of three, is not met.
    EXPECT_THAT(one.left_open, testing::Each("token_bus/channel_manager/ring/survives_the_cut_of_a_channel"))
        << one.role;
    EXPECT_GT(one.declarations, 0U) << one.role;
    EXPECT_LT(one.refused, one.pairs / 2) << one.role;
    RecordProperty(one.role, std::to_string(one.declarations) + " declarations of " +
                                 std::to_string(one.pairs) + " pairs");
  }
}

}  // namespace
}  // namespace fieldproof::conformance
