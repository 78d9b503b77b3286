#include "harness/measure/torn_image.hpp"

#include <gtest/gtest.h>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

using kernel::kMillisecond;
using kernel::kStart;

TEST(TornImageTest, WordsThatChangeTogetherAreWhole) {
  TornImageCounter counter(3);
  for (int n = 1; n <= 5; ++n) {
    for (const std::size_t word : {2U, 0U, 1U}) {
      counter.on_word(word, kStart + n * kMillisecond, static_cast<std::uint64_t>(n));
    }
  }
  counter.finish();
  EXPECT_EQ(counter.images(), 5U);
  EXPECT_EQ(counter.torn_images(), 0U);
}

TEST(TornImageTest, AWordThatStaysBehindTearsTheImage) {
  TornImageCounter counter(2);
  counter.on_word(0, kStart, 1);
  counter.on_word(1, kStart, 1);
  counter.on_word(0, kStart + kMillisecond, 2);
  counter.on_word(1, kStart + 2 * kMillisecond, 2);
  counter.finish();
  counter.finish();
  EXPECT_EQ(counter.images(), 3U);
  EXPECT_EQ(counter.torn_images(), 1U);
}

TEST(TornImageTest, TheLastImageIsJudgedAtTheEnd) {
  TornImageCounter counter(2);
  counter.on_word(0, kStart, 1);
  EXPECT_EQ(counter.torn_images(), 0U);
  counter.finish();
  EXPECT_EQ(counter.torn_images(), 1U);
}

TEST(TornImageTest, OneWordIsNeverTornAndTimeDoesNotRunBackwards) {
  TornImageCounter counter(1);
  counter.on_word(0, kStart + kMillisecond, 1);
  EXPECT_THROW(counter.on_word(0, kStart, 2), kernel::BrokenInvariant);
  counter.finish();
  EXPECT_EQ(counter.torn_images(), 0U);
}

}  // namespace
}  // namespace fieldproof::measure
