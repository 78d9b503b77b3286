#include <gtest/gtest.h>

#include <algorithm>

#include "harness/kernel/sanitized.hpp"
#include "papers/sections.hpp"

namespace fieldproof::papers {
namespace {

using reports::Reproduction;

TEST(ValveBusPaper, CyclesOfTheStationsAreTheClosedForm) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: a sanitizer sees this code in tests of its own folder";
  const reports::PublishedSection section = valve_bus_cycle_times({.seed = 3, .duration = kernel::kSecond});
  ASSERT_GE(section.rows.size(), 6U);
  for (std::size_t n = 0; n < 6; ++n) {
    EXPECT_EQ(reproduction_of(section.rows[n].compared), Reproduction::own) << section.rows[n].what;
    EXPECT_TRUE(section.rows[n].published.empty()) << "the paper prints no time";
  }
}

TEST(ValveBusPaper, TriedPatternsAreTheExactNumbers) {
  const reports::PublishedSection section = valve_bus_block_check({});
  EXPECT_EQ(section.rows.at(0).reproduced, "80, 2840, 58800");
  EXPECT_EQ(section.rows.at(1).reproduced, "24, 252, 1512");
  EXPECT_EQ(reproduction_of(section.rows.at(0).compared), Reproduction::own);
  EXPECT_EQ(reproduction_of(section.rows.at(1).compared), Reproduction::own);
}

TEST(ValveBusPaper, FindsTheRatesThatAreInStep) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: a sanitizer sees this code in tests of its own folder";
  const reports::PublishedSection section = valve_bus_resonance({.seed = 5, .duration = kernel::kSecond});
  const auto has = [&](std::string_view what) {
    return std::ranges::any_of(section.rows, [&](const auto& row) { return row.what == what; });
  };
  EXPECT_TRUE(has("P0, 11 bit: in step at 102.25 kHz"));
  EXPECT_TRUE(has("P2, 10 bit: in step at 112.50 kHz"));
  EXPECT_TRUE(has("P2, 10 bit: in step at 100.00 kHz"));
  EXPECT_FALSE(std::ranges::any_of(
      section.rows, [](const auto& row) { return row.what.starts_with("P1, even parity: in step"); }));
}

}  // namespace
}  // namespace fieldproof::papers
