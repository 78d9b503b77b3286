#include "harness/measure/comparison.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

Comparison delay(double measured, double standard_error = 0, bool is_bound = false) {
  return {"mean delay", "us", 1'500, measured, 1'000, "of the cycle time", standard_error, is_bound};
}

TEST(ComparisonTest, DeviationIsToldInPartsOfTheWhole) {
  EXPECT_DOUBLE_EQ(delay(1'520).deviation_percent(), 2);
  EXPECT_DOUBLE_EQ(delay(1'480).deviation_percent(), -2);
}

TEST(ComparisonTest, BothSidesOfTheTolerance) {
  EXPECT_EQ(agreement(delay(1'520), 2), Agreement::holds);
  EXPECT_EQ(agreement(delay(1'480), 2), Agreement::holds);
  EXPECT_EQ(agreement(delay(1'520.001), 2), Agreement::differs);
  EXPECT_EQ(agreement(delay(1'479.999), 2), Agreement::differs);
}

TEST(ComparisonTest, FewSamplesLeaveItOpen) {
  EXPECT_EQ(agreement(delay(1'550, 10), 2), Agreement::open);
  EXPECT_EQ(agreement(delay(1'551, 10), 2), Agreement::differs);
  EXPECT_EQ(agreement(delay(1'520, 10), 2), Agreement::holds);
}

TEST(ComparisonTest, BelowABoundIsAlwaysRight) {
  EXPECT_EQ(agreement(delay(3, 0, true), 2), Agreement::holds);
  EXPECT_EQ(agreement(delay(1'600, 0, true), 2), Agreement::differs);
}

TEST(ComparisonTest, TheWorstOfSeveralCounts) {
  EXPECT_EQ(agreement(std::vector<Comparison>{}, 2, Phase::quiet), std::nullopt);
  EXPECT_EQ(agreement(std::vector{delay(1'500), delay(1'550, 10)}, 2, Phase::quiet), Agreement::open);
  EXPECT_EQ(agreement(std::vector{delay(1'900), delay(1'550, 10)}, 2, Phase::quiet), Agreement::differs);
  EXPECT_EQ(name(Agreement::open), "open");
  EXPECT_THROW(agreement(Comparison{}, 2), kernel::BrokenInvariant);
}

}  // namespace
}  // namespace fieldproof::measure
