// Subject: the sections about a control loop over the fieldbus.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/kernel/sanitized.hpp"
#include "papers/sections.hpp"

namespace fieldproof::papers {
namespace {

using reports::Reproduction;
using testing::HasSubstr;

Settings short_run() {
  return {.seed = 1, .duration = 15 * kernel::kSecond};
}

TEST(ControlLoopPaper, LossAndVacantSamplingCostWhatThePaperSays) {
  const reports::PublishedSection section = control_loop_quiet(short_run());
  ASSERT_EQ(section.rows.size(), 10U);
  // Published data are as good as no bus.
  EXPECT_EQ(section.rows[0].reproduced, section.rows[1].reproduced);
  for (const std::size_t row : {8U, 9U}) {
    EXPECT_EQ(reproduction_of(section.rows[row].compared), Reproduction::agrees)
        << section.rows[row].reproduced;
    EXPECT_FALSE(section.rows[row].published.empty());
  }
  ASSERT_EQ(section.figures.size(), 2U);
  EXPECT_EQ(section.figures[0].curves.size(), 3U);
  EXPECT_EQ(section.figures[0].curves[0].points.size(), 600U);  // ten in each of 60 periods
}

TEST(ControlLoopPaper, BurstsAndLossesAreToldSampleBySample) {
  constexpr unsigned kPeriods = kernel::kIsSanitized ? 20 : 60;
  const reports::PublishedSection section =
      control_loop_under_bursts({.seed = 1, .duration = kPeriods * 250 * kernel::kMillisecond});
  ASSERT_EQ(section.rows.size(), 10U);
  EXPECT_THAT(section.rows[0].remark, HasSubstr(fmt::format("0 of {} lost, 0 missing, 0 vacant", kPeriods)));
  EXPECT_NE(section.rows[9].reproduced, section.rows[0].reproduced);
}

TEST(ControlLoopPaper, AnOperatorSeesWhatTheTargetRotationCosts) {
  const reports::PublishedSection section =
      control_loop_with_operator({.seed = 1, .duration = 5 * kernel::kSecond});
  ASSERT_EQ(section.rows.size(), 7U);
  for (const reports::PublishedRow& row : section.rows) {
    EXPECT_THAT(row.reproduced, HasSubstr("responses"));
    EXPECT_THAT(row.reproduced, HasSubstr("alarms"));
    EXPECT_THAT(row.reproduced, HasSubstr("trends"));
  }
}

}  // namespace
}  // namespace fieldproof::papers
