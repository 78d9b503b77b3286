// Subject: the sections about urgent data in the Foundation Fieldbus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/paper_sections.hpp"

namespace fieldproof::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(FoundationPaper, RotationsTakeWhatTheLoadSaysWhereQueuesAreStable) {
  const reports::PublishedSection section = foundation_shares({});
  ASSERT_EQ(section.rows.size(), 9U);
  for (const reports::PublishedRow& row : section.rows) {
    EXPECT_TRUE(row.published.empty()) << "the paper prints no number";
    EXPECT_EQ(row.agrees, true) << row.what << ": " << row.reproduced;
    EXPECT_THAT(row.remark, Not(HasSubstr("unstable")));
  }
}

TEST(FoundationPaper, ThirdEquationAsPrintedIsShown) {
  const reports::PublishedSection section = foundation_rotations({});
  ASSERT_EQ(section.rows.size(), 4U);
  EXPECT_THAT(section.rows[1].reproduced, HasSubstr("12493 as printed"));
}

}  // namespace
}  // namespace fieldproof::cli
