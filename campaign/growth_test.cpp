// Subject: how coverage grew in the searches of many jobs together.
#include "campaign/growth.hpp"

#include <gtest/gtest.h>

namespace fieldproof::campaign {
namespace {

Outcome searched(std::vector<GrowthPoint> growth) {
  Outcome outcome;
  outcome.growth = std::move(growth);
  return outcome;
}

std::vector<JointGrowth> together(const std::vector<Outcome>& jobs) {
  std::vector<const Outcome*> pointers;
  for (const Outcome& job : jobs) pointers.push_back(&job);
  return joint_growth(pointers);
}

TEST(Growth, OfJobsIsTheSumOfSequencesAndTheMostEdges) {
  const auto growth =
      together({searched({{1, 4}, {2, 9}, {5, 11}, {7, 12}}), searched({{1, 6}, {2, 7}, {3, 8}})});
  ASSERT_EQ(growth.size(), 4U);
  EXPECT_EQ(growth[0].run, 1U);
  EXPECT_EQ(growth[0].all, 2U);
  EXPECT_EQ(growth[0].edges, 6U);
  EXPECT_EQ(growth[1].edges, 9U);
  EXPECT_EQ(growth[2].all, 8U) << "the shorter one had 3 of 5";
  EXPECT_EQ(growth[3].run, 7U);
  EXPECT_EQ(growth[3].all, 10U);
  EXPECT_EQ(growth[3].edges, 12U);
}

TEST(Growth, OfNothingIsNothing) {
  EXPECT_TRUE(together({}).empty());
  EXPECT_TRUE(together({searched({})}).empty());
  EXPECT_EQ(text_of({}), "");
}

TEST(Growth, HasAFewPointsHoweverLongASearchIs) {
  const auto growth = together({searched({{1, 1}, {1'000'000'000, 900}})});
  EXPECT_EQ(growth.size(), 28U);
  EXPECT_EQ(growth.back().run, 1'000'000'000U);
}

TEST(Growth, IsToldAtPowersOfTenAndAtTheEnd) {
  const auto growth =
      together({searched({{1, 5}, {10, 20}, {100, 30}, {1000, 120}, {10'000, 131}, {12'345, 132}})});
  EXPECT_EQ(text_of(growth), "edges 30 after 100, 120 after 1,000, 131 after 10,000, 132 after 12,345");
}

}  // namespace
}  // namespace fieldproof::campaign
