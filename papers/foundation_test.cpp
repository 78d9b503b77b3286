// Subject: the sections about urgent data in the Foundation Fieldbus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "harness/kernel/sanitized.hpp"
#include "papers/sections.hpp"

namespace fieldproof::papers {
namespace {

using reports::Reproduction;
using testing::HasSubstr;
using testing::Not;

TEST(FoundationPaper, RotationsTakeWhatTheLoadSaysWhereQueuesAreStable) {
  const reports::PublishedSection section = foundation_shares({});
  ASSERT_EQ(section.rows.size(), 9U);
  for (const reports::PublishedRow& row : section.rows) {
    EXPECT_TRUE(row.published.empty()) << "the paper prints no number";
    EXPECT_EQ(reproduction_of(row.compared), Reproduction::own) << row.what << ": " << row.reproduced;
    EXPECT_THAT(row.remark, Not(HasSubstr("unstable")));
  }
}

TEST(FoundationPaper, ThirdEquationAsPrintedIsShown) {
  const reports::PublishedSection section = foundation_rotations({});
  ASSERT_EQ(section.rows.size(), 4U);
  EXPECT_THAT(section.rows[1].reproduced, HasSubstr("12493 as printed"));
}

TEST(FoundationPaper, StationsAgreeWithTheSimulationWithoutFrames) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: a sanitizer sees this code in tests of its own folder";
  const reports::PublishedSection section =
      foundation_stations({.seed = 1, .duration = 10 * kernel::kSecond});
  ASSERT_EQ(section.rows.size(), 18U);
  // In so short a time some rows leave it open.
  EXPECT_GE(std::ranges::count_if(section.rows,
                                  [](const reports::PublishedRow& row) {
                                    return reproduction_of(row.compared) == Reproduction::own;
                                  }),
            9);
  for (const reports::PublishedRow& row : section.rows)
    EXPECT_THAT(reproduction_of(row.compared), testing::AnyOf(Reproduction::own, Reproduction::inconclusive))
        << row.what << ": " << row.reproduced << "; " << row.remark;
}

TEST(FoundationPaper, DrawsDelayOverTtrtForEachLoad) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: a sanitizer sees this code in tests of its own folder";
  const reports::PublishedSection section = foundation_targets({});
  ASSERT_EQ(section.figures.size(), 3U);
  for (const reports::PublishedCurves& figure : section.figures) {
    ASSERT_EQ(figure.curves.size(), 3U);
    EXPECT_EQ(figure.curves[0].points.size(), 7U);
  }
}

}  // namespace
}  // namespace fieldproof::papers
