#include "harness/fault/rule.hpp"

#include <gtest/gtest.h>

namespace fieldproof::fault {
namespace {

TEST(Pattern, StarTakesAnythingAndQuestionMarkOneCharacter) {
  EXPECT_TRUE(fits("*", ""));
  EXPECT_TRUE(fits("", ""));
  EXPECT_FALSE(fits("", "a"));
  EXPECT_TRUE(fits("slave ? in", "slave 2 in"));
  EXPECT_FALSE(fits("slave ? in", "slave 12 in"));
  EXPECT_TRUE(fits("slave * in", "slave 12 in"));
  EXPECT_FALSE(fits("slave * in", "slave 12 out"));
  EXPECT_TRUE(fits("*a*b", "xaabab"));
  EXPECT_FALSE(fits("*a*b", "xaaba"));
  EXPECT_TRUE(fits("a**", "a"));
  EXPECT_FALSE(fits("a?", "a"));
}

TEST(Numbers, HoldBothEndsAndEveryNth) {
  EXPECT_TRUE(Numbers{}.contains(0));
  const Numbers range{3, 9, 3};
  EXPECT_FALSE(range.contains(2));
  EXPECT_TRUE(range.contains(3));
  EXPECT_FALSE(range.contains(4));
  EXPECT_TRUE(range.contains(9));
  EXPECT_FALSE(range.contains(12));
  EXPECT_FALSE(Numbers::only(5).contains(4));
  EXPECT_TRUE(Numbers::only(5).contains(5));
  EXPECT_FALSE(Numbers::only(5).contains(6));
}

TEST(Effect, HasTheWordOfPlansAndTraces) {
  EXPECT_EQ(word_of(Flip{}), "flip");
  EXPECT_EQ(word_of(Force{}), "force");
  EXPECT_EQ(word_of(Delay{}), "delay");
  EXPECT_EQ(word_of(Drop{}), "drop");
  EXPECT_EQ(word_of(Repeat{}), "repeat");
  EXPECT_EQ(word_of(Insert{}), "insert");
  EXPECT_EQ(word_of(Mute{}), "mute");
}

}  // namespace
}  // namespace fieldproof::fault
