// Subject: the sections about the allocation of bandwidth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "harness/kernel/sanitized.hpp"
#include "papers/sections.hpp"

namespace fieldproof::papers {
namespace {

using reports::Reproduction;
using testing::HasSubstr;

Settings of_a_second() {
  return {.seed = 1, .duration = kernel::kSecond};
}

// Which rows disagree, by the begin of what they are about.
std::map<std::string, std::string> disagreeing(const reports::PublishedSection& section) {
  std::map<std::string, std::string> rows;
  for (const reports::PublishedRow& row : section.rows) {
    if (reproduction_of(row.compared) == Reproduction::differs)
      rows[row.what] = row.reproduced + "; " + row.remark;
  }
  return rows;
}

class BandwidthPaper : public testing::Test {
 protected:
  void SetUp() override {
    if (kernel::kIsSanitized)
      GTEST_SKIP() << "not applicable: a sanitizer sees this code in tests of its own folder";
  }
};

TEST_F(BandwidthPaper, WindowsKeepTheirSlotsAndNeedOneGrid) {
  const reports::PublishedSection section = bandwidth_periodic(of_a_second());
  ASSERT_EQ(section.rows.size(), 5U);
  const auto rows = disagreeing(section);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_THAT(rows.at("(C1) holds where no delay is over T_i"), HasSubstr("it also needs one grid for all"));
  ASSERT_EQ(section.figures.size(), 1U);
  ASSERT_EQ(section.figures[0].curves.size(), 1U) << "nothing but periodic data";
  EXPECT_EQ(section.figures[0].curves[0].points.size(), 4U * 12) << "four data in each of three slots";
}

TEST_F(BandwidthPaper, ThePrintedLengthHoldsForAWholeDensityOnly) {
  const reports::PublishedSection section = bandwidth_non_real_time(of_a_second());
  ASSERT_EQ(section.rows.size(), 10U);
  const auto rows = disagreeing(section);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_THAT(rows.at("the same, density 3.75"), HasSubstr("8; slots have 3 to 4 data"));
  EXPECT_THAT(rows.at("L_n as printed, density 3.75"), HasSubstr("Before it go 8 non-real-time packets"));
  ASSERT_EQ(section.figures.size(), 2U);
  for (const reports::PublishedCurves& figure : section.figures) EXPECT_EQ(figure.curves.size(), 2U);
}

TEST_F(BandwidthPaper, RealTimeDataNeedShorterPackets) {
  const reports::PublishedSection section = bandwidth_real_time(of_a_second());
  ASSERT_EQ(section.rows.size(), 7U);
  const auto rows = disagreeing(section);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_TRUE(rows.contains("L_n as printed"));
  EXPECT_TRUE(rows.contains("real-time delays with L_n as printed"));
  ASSERT_EQ(section.figures.size(), 1U);
  EXPECT_EQ(section.figures[0].curves.size(), 3U);
}

TEST_F(BandwidthPaper, TheSchemeIsWorthItToAControlLoop) {
  const reports::PublishedSection section = bandwidth_loop({.seed = 1, .duration = 20 * kernel::kSecond});
  ASSERT_EQ(section.rows.size(), 7U);
  EXPECT_TRUE(disagreeing(section).empty());
  EXPECT_THAT(section.rows[1].remark, HasSubstr("0 vacant, 0 samples lost"));
  ASSERT_EQ(section.figures.size(), 2U);
  EXPECT_EQ(section.figures[0].curves.size(), 3U);
  EXPECT_GT(section.figures[0].curves[0].points.size(), 1'000U);
}

TEST_F(BandwidthPaper, StationsSendTheSame) {
  const reports::PublishedSection section = bandwidth_stations(of_a_second());
  ASSERT_EQ(section.rows.size(), 4U);
  EXPECT_TRUE(disagreeing(section).empty());
}

}  // namespace
}  // namespace fieldproof::papers
