#include "conformance/covering_array.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace fieldproof::conformance {
namespace {

using Pair = std::tuple<std::size_t, std::size_t, std::size_t, std::size_t>;

std::set<Pair> pairs_in(const std::vector<ValueRow>& rows) {
  std::set<Pair> pairs;
  for (const ValueRow& row : rows)
    for (std::size_t one = 0; one < row.size(); ++one)
      for (std::size_t other = one + 1; other < row.size(); ++other)
        pairs.insert({one, row[one], other, row[other]});
  return pairs;
}

std::vector<std::size_t> any_factors() {
  return *rc::gen::resize(12,
                          rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(1, 6)));
}

RC_GTEST_PROP(CoveringArray, HasEachTwoValuesOfTwoFactorsInARow, (std::uint64_t seed)) {
  const std::vector<std::size_t> values = any_factors();
  const CoveringArray array =
      covering_array(values, [](const ValueRow&) { return true; }, kernel::Random(seed));
  RC_ASSERT(array.left_out == 0U);
  RC_ASSERT(pairs_in(array.rows).size() == array.pairs);
  for (const ValueRow& row : array.rows)
    for (std::size_t factor = 0; factor < values.size(); ++factor) RC_ASSERT(row[factor] < values[factor]);
}

// The first two factors never have their last values together.
RC_GTEST_PROP(CoveringArray, LeavesOutWhatMayNotBe, (std::uint64_t seed)) {
  std::vector<std::size_t> values = any_factors();
  values.insert(values.begin(), {3, 4});
  const auto may_be = [](const ValueRow& row) { return row[0] != 2 || row[1] != 3; };
  const CoveringArray array = covering_array(values, may_be, kernel::Random(seed));
  RC_ASSERT(array.left_out == 1U);
  RC_ASSERT(pairs_in(array.rows).size() == array.pairs - 1);
  RC_ASSERT(std::ranges::all_of(array.rows, may_be));
}

TEST(CoveringArray, IsFarSmallerThanAllCombinations) {
  const std::vector<std::size_t> twenty_of_three(20, 3);
  const auto any = [](const ValueRow&) { return true; };
  const CoveringArray array = covering_array(twenty_of_three, any, kernel::Random(1));
  EXPECT_LE(array.rows.size(), 40U);  // of 3^20; nobody can do with less than 9
  EXPECT_EQ(array.rows, covering_array(twenty_of_three, any, kernel::Random(1)).rows);
}

TEST(CoveringArray, OfOneFactorOrNoneHasNoPairs) {
  const auto any = [](const ValueRow&) { return true; };
  EXPECT_TRUE(covering_array({}, any, kernel::Random(1)).rows.empty());
  EXPECT_TRUE(covering_array({5}, any, kernel::Random(1)).rows.empty());
}

}  // namespace
}  // namespace fieldproof::conformance
