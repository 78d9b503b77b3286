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
  EXPECT_THAT(false_alarms_of_answers(*token_bus_suite(), 64), testing::IsEmpty());
}

}  // namespace
}  // namespace fieldproof::conformance
