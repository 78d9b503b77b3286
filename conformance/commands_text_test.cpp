#include "conformance/commands_text.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace fieldproof::conformance {
namespace {

TEST(CommandsText, SaysOnceWhatComesSeveralTimesInARow) {
  CommandsText said;
  EXPECT_EQ(said.text(), "");
  said.add("id");
  for (int n = 0; n < 256; ++n) said.add("data; a level flipped");
  said.add("id");
  EXPECT_EQ(said.text(), "id / 256 times data; a level flipped / id");
}

TEST(CommandsText, OfManyCommandsHasTheLastAndHowManyWereBefore) {
  CommandsText said;
  for (int n = 0; n < 25; ++n) said.add(fmt::format("data {}", n));
  EXPECT_TRUE(said.text().starts_with("15 others / data 15 / ")) << said.text();
  EXPECT_TRUE(said.text().ends_with(" / data 24")) << said.text();
}

}  // namespace
}  // namespace fieldproof::conformance
