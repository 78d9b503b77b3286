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

TEST(TokenBusSuite, AnswersAtTheEndsOfTheirRangesAccuseNoReference) {
  EXPECT_THAT(false_alarms_at_ends(*token_bus_suite(), 32), testing::IsEmpty());
}

}  // namespace
}  // namespace fieldproof::conformance
