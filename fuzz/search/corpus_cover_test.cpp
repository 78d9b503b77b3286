// Subject: which inputs are enough to pass what all of them pass.
#include "fuzz/search/corpus_cover.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

namespace fieldproof::fuzz {
namespace {

using Places = std::vector<std::size_t>;

std::set<std::uint64_t> passed_by(const std::vector<CoveringInput>& inputs, const Places& places) {
  std::set<std::uint64_t> all;
  for (const std::size_t place : places)
    all.insert(inputs[place].features.begin(), inputs[place].features.end());
  return all;
}

TEST(CorpusCover, TakesTheShorterOfTwoThatPassTheSame) {
  const std::vector<CoveringInput> inputs{{{1, 2, 3}, {7, 8}}, {{9}, {7, 8}}, {{4, 4}, {8}}};
  EXPECT_EQ(smallest_cover(inputs), Places{1});
}

TEST(CorpusCover, DropsAShortOneWhoseFeaturesLongerOnesPassAnyway) {
  const std::vector<CoveringInput> inputs{{{1}, {5}}, {{1, 1}, {5, 6}}, {{1, 1, 1}, {7}}};
  EXPECT_EQ(smallest_cover(inputs), (Places{1, 2}));
}

TEST(CorpusCover, OfNothingIsNothing) {
  EXPECT_EQ(smallest_cover({}), Places{});
  EXPECT_EQ(smallest_cover(std::vector<CoveringInput>{{{1}, {}}}), Places{});
}

RC_GTEST_PROP(CorpusCover, PassesAllAndHasNoneTooMany, ()) {
  std::vector<CoveringInput> inputs;
  const auto drawn = *rc::gen::container<std::vector<std::vector<std::uint64_t>>>(
      rc::gen::container<std::vector<std::uint64_t>>(rc::gen::inRange<std::uint64_t>(0, 12)));
  for (const auto& numbers : drawn) {
    const std::set<std::uint64_t> features(numbers.begin(), numbers.end());
    inputs.push_back({*rc::gen::arbitrary<std::vector<std::uint8_t>>(), {features.begin(), features.end()}});
  }
  Places all(inputs.size());
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = n;
  const Places cover = smallest_cover(inputs);
  RC_ASSERT(passed_by(inputs, cover) == passed_by(inputs, all));
  for (std::size_t left_out = 0; left_out < cover.size(); ++left_out) {
    Places others = cover;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    RC_ASSERT(passed_by(inputs, others) != passed_by(inputs, all));
  }
}

}  // namespace
}  // namespace fieldproof::fuzz
