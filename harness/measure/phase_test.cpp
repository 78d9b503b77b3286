#include "harness/measure/phase.hpp"

#include <gtest/gtest.h>

namespace fieldproof::measure {
namespace {

TEST(PhaseTest, WithoutADisturbanceAllIsQuiet) {
  EXPECT_EQ(phase_during(nullptr, kernel::kStart, kernel::kNever), Phase::quiet);
  const PhaseDuring always = [](kernel::Time, kernel::Time) { return Phase::recovery; };
  EXPECT_EQ(phase_during(always, kernel::kStart, kernel::kStart), Phase::recovery);
}

TEST(PhaseTest, EachPhaseHasItsValuesAndTheTotalHasAll) {
  PhasedDistribution values;
  values.add(Phase::quiet, std::int64_t{1});
  values.add(Phase::burst, std::int64_t{5});
  values.add(Phase::burst, kernel::Duration{7});
  EXPECT_EQ(values.in(Phase::quiet).max(), 1);
  EXPECT_EQ(values.in(Phase::burst).count(), 2U);
  EXPECT_TRUE(values.in(Phase::recovery).is_empty());
  EXPECT_EQ(values.total().count(), 3U);
  EXPECT_EQ(values.total().max(), 7);
  PhasedDistribution more = values;
  more.add(values);
  EXPECT_EQ(more.in(Phase::burst).count(), 4U);
  EXPECT_EQ(more.in(Phase::quiet).count(), 2U);
}

TEST(PhaseTest, HaveNames) {
  EXPECT_EQ(name(Phase::quiet), "quiet");
  EXPECT_EQ(name(Phase::burst), "burst");
  EXPECT_EQ(name(Phase::recovery), "recovery");
}

}  // namespace
}  // namespace fieldproof::measure
