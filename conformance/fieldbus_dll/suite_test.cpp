#include "conformance/fieldbus_dll/suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conformance/false_alarms.hpp"

namespace fieldproof::conformance {
namespace {

TEST(FieldbusDllSuite, ReferencesPassInManySeedsWithoutAFalseAlarm) {
  const auto suite = fieldbus_dll_suite();
  for (std::uint64_t seed = 1; seed <= many_seeds(); ++seed) {
    EXPECT_THAT(false_alarms(*suite, seed), testing::IsEmpty());
  }
}

}  // namespace
}  // namespace fieldproof::conformance
