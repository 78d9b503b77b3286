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

// Whoever declares a number at an end of its range is judged by it: what the reference does then is right.
// Where numbers contradict each other a case may leave it open.
TEST(TokenBusSuite, NumbersAtTheEndsOfTheirRangesAccuseNoReference) {
  const auto suite = token_bus_suite();
  for (kernel::FewerIfSanitized few(32); const judge::PicsItem& item : suite->pics_items()) {
    if (item.kind != judge::PicsKind::number || few.leaves_out()) continue;
    for (const std::int64_t end : {item.least, item.most}) {
      conformance::Setup setup;
      setup.volume = Volume::quick;
      setup.pics.emplace().declare(item.name, end);
      const auto is_accused = [](judge::Verdict verdict) { return verdict >= judge::Verdict::fail; };
      EXPECT_THAT(cases_where(*suite, setup, is_accused), testing::IsEmpty()) << item.name << " " << end;
    }
  }
}

}  // namespace
}  // namespace fieldproof::conformance
