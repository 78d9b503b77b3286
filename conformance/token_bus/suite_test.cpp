#include "conformance/token_bus/suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conformance/false_alarms.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

TEST(TokenBusSuite, ReferencesPassInManySeedsWithoutAFalseAlarm) {
  const auto suite = token_bus_suite();
  for (std::uint64_t seed = 1; seed <= kManySeeds; ++seed) {
    EXPECT_THAT(false_alarms(*suite, seed), testing::IsEmpty());
  }
}

TEST(TokenBusSuite, NoTwoAnswersOfAPicsAccuseAReference) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: minutes of the cases that other tests run under sanitizers";
  EXPECT_THAT(false_alarms_of_answers(*token_bus_suite(), 1), testing::IsEmpty());
}

}  // namespace
}  // namespace fieldproof::conformance
