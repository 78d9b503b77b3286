// Subject: minimise.hpp
#include "conformance/minimise.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace fieldproof::conformance {
namespace {

std::vector<int> numbers_up_to(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

bool has_all(const std::vector<int>& parts, const std::set<int>& wanted) {
  return std::ranges::all_of(wanted, [&](int one) { return std::ranges::find(parts, one) != parts.end(); });
}

RC_GTEST_PROP(Minimise, LeavesExactlyThePartsThatMatter, ()) {
  const auto wanted = *rc::gen::container<std::set<int>>(rc::gen::inRange(0, 300));
  int asked = 0;
  const std::vector<int> left = fewest(numbers_up_to(300), [&](const std::vector<int>& parts) {
    ++asked;
    return has_all(parts, wanted);
  });
  RC_ASSERT(left == std::vector<int>(wanted.begin(), wanted.end()));
  RC_ASSERT(asked <= 700 + 20 * static_cast<int>(wanted.size()));
}

TEST(Minimise, FindsOneOfTenThousandInFewSteps) {
  int asked = 0;
  const auto left = fewest(numbers_up_to(10'000), [&](const std::vector<int>& parts) {
    ++asked;
    return has_all(parts, {7'777});
  });
  EXPECT_EQ(left, std::vector<int>{7'777});
  EXPECT_LE(asked, 40);
}

TEST(Minimise, TakesAwayWhatWasNeededOnlyByWhatHasGone) {
  // 1 is needed as long as 0 is there.
  const auto left = fewest(numbers_up_to(4), [](const std::vector<int>& parts) {
    return has_all(parts, {3}) && (!has_all(parts, {0}) || has_all(parts, {1}));
  });
  EXPECT_EQ(left, std::vector<int>{3});
}

TEST(Minimise, KeepsWhatFailsWhenThereIsNoTimeLeft) {
  const auto nothing_fails = [](const std::vector<int>&) { return false; };
  EXPECT_EQ(fewest(numbers_up_to(9), nothing_fails), numbers_up_to(9));
  EXPECT_EQ(simplest(9, 0, [](int) { return false; }), 9);
}

TEST(Minimise, SearchesANumberByHalves) {
  EXPECT_EQ(simplest(100'000, 0, [](int number) { return number >= 777; }), 777);
  EXPECT_EQ(simplest(-100, 5, [](int number) { return number <= -3; }), -3);
  EXPECT_EQ(simplest(12, 12, [](int) { return false; }), 12);
}

}  // namespace
}  // namespace fieldproof::conformance
