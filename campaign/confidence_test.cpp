#include "campaign/confidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace fieldproof::campaign {
namespace {

// Exact where nothing was wrong or all was: 1 - alpha^(1/n); in between it is not asked for here.
double bound_of_none(std::uint64_t wrong, std::uint64_t total, double confidence) {
  if (wrong == total) return 1;
  return 1 - std::pow(1 - confidence, 1 / static_cast<double>(total - wrong));
}

Outcome job(std::uint64_t sent, std::uint64_t wrong, std::uint64_t differed = 0) {
  Outcome outcome;
  outcome.ledger = {{"sent", sent}, {"data_differed", differed}, {"wrong_cycles", wrong}};
  return outcome;
}

TEST(ConfidenceTest, LooksAfterPowersOfTwoAndSpendsItsRiskOnce) {
  std::vector<double> levels;
  Confidence confidence({.rate = 1e-9, .confidence = 0.95},
                        [&](std::uint64_t wrong, std::uint64_t total, double level) {
                          levels.push_back(level);
                          return bound_of_none(wrong, total, level);
                        });
  for (int n = 0; n < 100; ++n) EXPECT_FALSE(confidence.add(job(10, 0)));
  confidence.end();
  EXPECT_EQ(levels.size(), 8U);  // after 1, 2, 4 ... 64, and at the end
  double risk = 0;
  for (const double level : levels) risk += 1 - level;
  EXPECT_LT(risk, 0.05);
  EXPECT_GT(risk, 0.04);
  EXPECT_NEAR(levels.front(), 0.975, 1e-12);
}

// 1 - 0.025^(1/n) falls below 1e-3 between n = 3687 and 3688.
TEST(ConfidenceTest, IsBelowFromTheFirstTotalThatShowsIt) {
  Confidence one_less({.rate = 1e-3}, bound_of_none);
  EXPECT_FALSE(one_less.add(job(3687, 0)));
  EXPECT_EQ(one_less.decision(), Decision::open);
  Confidence enough({.rate = 1e-3}, bound_of_none);
  EXPECT_TRUE(enough.add(job(3688, 0)));
  EXPECT_EQ(enough.decision(), Decision::below);
}

TEST(ConfidenceTest, IsAboveWhereTheLowerBoundIs) {
  Confidence confidence({.rate = 0.1, .is_of_differed = true}, bound_of_none);
  EXPECT_TRUE(confidence.add(job(1'000'000, 50, 50)));
  EXPECT_EQ(confidence.decision(), Decision::above);
  EXPECT_GT(confidence.lower(), 0.9);
}

TEST(ConfidenceTest, LooksAtJobsWithALedgerOnly) {
  Confidence confidence({.rate = 1e-3}, bound_of_none);
  EXPECT_FALSE(confidence.add(Outcome{}));
  EXPECT_EQ(confidence.looks(), 0U);
  confidence.end();
  EXPECT_EQ(confidence.decision(), Decision::open);
}

}  // namespace
}  // namespace fieldproof::campaign
