#include "conformance/valve_bus/suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conformance/false_alarms.hpp"

namespace fieldproof::conformance {
namespace {

TEST(ValveBusSuite, ReferencesPassInManySeedsWithoutAFalseAlarm) {
  const auto suite = valve_bus_suite();
  for (std::uint64_t seed = 1; seed <= kManySeeds; ++seed) {
    EXPECT_THAT(false_alarms(*suite, seed), testing::IsEmpty());
  }
  // Here two pitches of a scan come out alike at first sight.
  EXPECT_THAT(false_alarms(*suite, 1019), testing::IsEmpty());
  EXPECT_THAT(false_alarms(*suite, 1094), testing::IsEmpty());
}

}  // namespace
}  // namespace fieldproof::conformance
