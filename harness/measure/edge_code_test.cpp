#include "harness/measure/edge_code.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

TEST(EdgeCodeTest, BitZeroIsTheSignal) {
  const EdgeCode code;
  EXPECT_EQ(code.word(0), 0);
  for (std::uint64_t n = 0; n < 70'000; ++n) EXPECT_EQ(code.word(n) & 1, n & 1);
}

TEST(EdgeCodeTest, WordsOfOneRoundAreAllDifferent) {
  const EdgeCode code;
  std::set<std::uint16_t> words;
  for (std::uint64_t n = 0; n < 65'536; ++n) words.insert(code.word(n));
  EXPECT_EQ(words.size(), 65'536U);
}

RC_GTEST_PROP(EdgeCodeTest, TheLatestNumberIsFound, ()) {
  const auto bits = *rc::gen::inRange(1U, 17U);
  const EdgeCode code(bits);
  const auto number = *rc::gen::inRange<std::uint64_t>(0, 1'000'000);
  const auto behind = *rc::gen::inRange<std::uint64_t>(0, std::uint64_t{1} << bits);
  RC_ASSERT(code.edges(code.word(number), number + behind) == std::optional{number});
  if (number >= std::uint64_t{1} << bits) {
    RC_ASSERT(code.edges(code.word(number), number - 1) ==
              std::optional{number - (std::uint64_t{1} << bits)});
  } else if (number > 0) {
    RC_ASSERT(!code.edges(code.word(number), number - 1).has_value());
  }
}

// What the numbers are for: of the words that mix bits of two neighbours, few pass as a recent edge.
TEST(EdgeCodeTest, MixedWordsAreSeldomRecentEdges) {
  const EdgeCode code;
  int mixed = 0;
  int unnoticed = 0;
  for (std::uint64_t n = 100; n < 1'100; ++n) {
    const std::uint16_t before = code.word(n - 1);
    const std::uint16_t after = code.word(n);
    for (unsigned cut = 1; cut < 16; ++cut) {
      const auto low = static_cast<std::uint16_t>((1U << cut) - 1);
      const auto word = static_cast<std::uint16_t>((after & low) | (before & ~low));
      if (word == before || word == after) continue;
      ++mixed;
      const auto number = code.edges(word, n);
      if (number && *number + 8 >= n) ++unnoticed;
    }
  }
  EXPECT_GT(mixed, 10'000);
  EXPECT_LT(unnoticed, mixed / 100);
}

TEST(EdgeCodeTest, BitsBeyondTheWordAreNoEdge) {
  const EdgeCode nibble(4);
  EXPECT_FALSE(nibble.edges(0x10, 100).has_value());
  EXPECT_THROW(EdgeCode(0), kernel::BrokenInvariant);
  EXPECT_THROW(EdgeCode(17), kernel::BrokenInvariant);
}

}  // namespace
}  // namespace fieldproof::measure
