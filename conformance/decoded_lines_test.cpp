#include "conformance/decoded_lines.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace fieldproof::conformance {
namespace {

DecodedLines thirty_lines() {
  DecodedLines lines;
  for (int ms = 30; ms >= 1; --ms)
    lines.add(kernel::kStart + ms * kernel::kMillisecond, fmt::format("{} ms", ms));
  return lines;
}

// What a finding in the middle of a long case is about does not stand at the end of the case.
TEST(DecodedLines, AreThoseAroundTheFinding) {
  const std::vector<std::string> lines = thirty_lines().around(kernel::kStart + 15 * kernel::kMillisecond);
  ASSERT_EQ(lines.size(), 12U);
  EXPECT_EQ(lines.front(), "6 ms");
  EXPECT_EQ(lines.back(), "17 ms");
}

TEST(DecodedLines, AreTheFirstAtTheBeginAndTheLastAtTheEnd) {
  EXPECT_EQ(thirty_lines().around(kernel::kStart), (std::vector<std::string>{"1 ms", "2 ms"}));
  EXPECT_EQ(thirty_lines().last().back(), "30 ms");
  EXPECT_EQ(thirty_lines().last().size(), 12U);
  EXPECT_EQ(DecodedLines().last(), (std::vector<std::string>{"nothing was driven by anybody"}));
}

}  // namespace
}  // namespace fieldproof::conformance
