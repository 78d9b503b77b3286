// Subject: the sections about the token bus on the physical layer of IEEE 802.3.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/kernel/sanitized.hpp"
#include "papers/sections.hpp"

namespace fieldproof::papers {
namespace {

using reports::Reproduction;
using testing::HasSubstr;

TEST(ControlNetworkPaper, CodesAsItsTableSays) {
  const reports::PublishedSection section = control_network_coding({});
  ASSERT_EQ(section.rows.size(), 10U);
  for (const reports::PublishedRow& row : section.rows) {
    if (row.published.empty()) continue;
    const bool is_contradicted = row.what == "SD begins with, in the text";
    EXPECT_EQ(reproduction_of(row.compared), is_contradicted ? Reproduction::differs : Reproduction::agrees)
        << row.what << ": " << row.reproduced;
  }
  EXPECT_THAT(section.rows.back().reproduced, HasSubstr("240 bits of the line, 24.0 us"));
}

TEST(ControlNetworkPaper, RotationsReachTheirBoundAndNeverExceedIt) {
  const reports::PublishedSection section = control_network_rotation({});
  ASSERT_EQ(section.rows.size(), 12U);
  for (const reports::PublishedRow& row : section.rows)
    EXPECT_EQ(reproduction_of(row.compared), Reproduction::own) << row.what << ": " << row.reproduced;
  ASSERT_EQ(section.figures.size(), 1U);
  EXPECT_EQ(section.figures[0].curves[0].points.size(), 6U);
}

TEST(ControlNetworkPaper, CsmaCdIsLateWhereTheTokenIsNot) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: a sanitizer sees this code in tests of its own folder";
  const reports::PublishedSection section = control_network_access({});
  ASSERT_EQ(section.rows.size(), 9U);
  EXPECT_THAT(section.rows.back().reproduced,
              HasSubstr("token: 4 frames in a millisecond; CSMA/CD: 2 frames in a millisecond"));
  // In the mean CSMA/CD is faster where there is little to do; what one frame in 10,000 takes is not.
  const reports::PublishedCurves& rare = section.figures.at(0);
  ASSERT_EQ(rare.curves.size(), 2U);
  EXPECT_LT(rare.curves[0].points.at(2).y, rare.curves[1].points.at(2).y);
}

// Seven kinds, one of them with a burst alone, and five sizes.
TEST(ControlNetworkPaper, TheRingIsWholeAgainWithinWhatItsTimersAllow) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: a sanitizer sees this code in tests of its own folder";
  const reports::PublishedSection section =
      control_network_recovery({.seed = 3, .duration = kernel::kSecond / 5});
  ASSERT_EQ(section.rows.size(), 18U);
  for (const reports::PublishedRow& row : section.rows) {
    EXPECT_NE(reproduction_of(row.compared), Reproduction::differs) << row.what << ": " << row.remark;
    if (row.what == "a station dies, and a burst") {
      EXPECT_THAT(row.remark, HasSubstr("2 instants; 0 over"));
    }
  }
  EXPECT_THAT(section.rows.back().what, HasSubstr("64 stations"));
}

}  // namespace
}  // namespace fieldproof::papers
