#include "harness/config/nearest.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>

namespace fieldproof::config {
namespace {

TEST(EditDistance, CountsEachKindOfEdit) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("slave", "slave"), 0U);
  EXPECT_EQ(edit_distance("slave", "slaves"), 1U);
  EXPECT_EQ(edit_distance("slave", "save"), 1U);
  EXPECT_EQ(edit_distance("slave", "slove"), 1U);
  EXPECT_EQ(edit_distance("slave", "salve"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("ca", "abc"), 3U) << "a swapped pair is not edited again";
}

TEST(EditDistance, LooksAtTheFirst256OctetsOnly) {
  const std::string longest(256, 'a');
  EXPECT_EQ(edit_distance(longest, longest + "bcd"), 0U);
  EXPECT_EQ(edit_distance(std::string(300, 'b'), longest), 256U);
}

TEST(Nearest, OrdersByDistanceThenByPosition) {
  const std::array<std::string_view, 5> ids{"master/reset", "slave/rest", "slave/reset", "slave/resit", "x"};
  const auto found = nearest("slave/reset", ids, 3);
  EXPECT_EQ(found, (std::vector<std::string_view>{"slave/reset", "slave/rest", "slave/resit"}));
  EXPECT_EQ(nearest("slave/reset", ids, 9).size(), 5U);
  EXPECT_TRUE(nearest("slave/reset", std::span<const std::string>{}, 3).empty());
}

TEST(Misspelled, AcceptsUpToAThird) {
  const std::array<std::string_view, 2> words{"station", "id"};
  EXPECT_EQ(misspelled("statoins", words), "station");
  EXPECT_EQ(misspelled("stxxxon", words), std::nullopt);
  EXPECT_EQ(misspelled("ld", words), "id");
  EXPECT_EQ(misspelled("lo", words), std::nullopt);
}

RC_GTEST_PROP(EditDistance, IsAMetricOfItsWords, (const std::string& a, const std::string& b)) {
  const std::size_t distance = edit_distance(a, b);
  RC_ASSERT(distance == edit_distance(b, a));
  RC_ASSERT((distance == 0) == (a == b));
  RC_ASSERT(distance <= std::max(a.size(), b.size()));
  RC_ASSERT(distance >= std::max(a.size(), b.size()) - std::min(a.size(), b.size()));
}

RC_GTEST_PROP(EditDistance, OfKEditsIsAtMostK, (std::string word)) {
  const std::string original = word;
  const auto edits = *rc::gen::inRange<std::size_t>(0, 5);
  for (std::size_t n = 0; n < edits; ++n) {
    const auto at = *rc::gen::inRange<std::size_t>(0, word.size() + 1);
    const bool inserts = at == word.size() || *rc::gen::arbitrary<bool>();
    if (inserts) {
      word.insert(at, 1, *rc::gen::character<char>());
    } else {
      word.erase(at, 1);
    }
  }
  RC_ASSERT(edit_distance(original, word) <= edits);
}

}  // namespace
}  // namespace fieldproof::config
