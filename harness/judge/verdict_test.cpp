#include "harness/judge/verdict.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace fieldproof::judge {
namespace {

constexpr std::array kByWeight = {Verdict::none, Verdict::not_applicable, Verdict::pass,
                                  Verdict::warn, Verdict::inconclusive,   Verdict::fail,
                                  Verdict::error};
constexpr std::array kStandings = {Standing::seed,    Standing::sure,   Standing::searched, Standing::calc,
                                   Standing::derived, Standing::memory, Standing::own};

TEST(Verdict, IsOrderedByWeight) {
  EXPECT_TRUE(std::is_sorted(kByWeight.begin(), kByWeight.end()));
}

TEST(Verdict, IsFoundByItsName) {
  for (const Verdict verdict : kByWeight) EXPECT_EQ(verdict_from(name(verdict)), verdict);
  EXPECT_EQ(name(Verdict::not_applicable), "not-applicable");
  EXPECT_EQ(verdict_from("PASS"), std::nullopt);
  EXPECT_EQ(verdict_from(""), std::nullopt);
}

TEST(Standing, IsFoundByItsName) {
  for (const Standing standing : kStandings) EXPECT_EQ(standing_from(name(standing)), standing);
  EXPECT_EQ(standing_from("rumour"), std::nullopt);
}

TEST(Standing, TheWeakerOneDecidesWhereTwoSourcesAreNeeded) {
  const Reference book{"a book", "page 3", Standing::searched};
  const Reference choice{"this project's choice", "the coding", Standing::own};
  const Reference both = resting_on_both(book, choice);
  EXPECT_EQ(both.source, "a book");
  EXPECT_EQ(both.clause, "page 3; this project's choice: the coding");
  EXPECT_EQ(both.standing, Standing::own);
  EXPECT_EQ(resting_on_both(choice, book).standing, Standing::own);
  EXPECT_EQ(resting_on_both({"a book", "", Standing::memory}, {"a paper", "", Standing::seed}).clause,
            "a paper");
  EXPECT_EQ(resting_on_both({"a book", "", Standing::memory}, {"a paper", "", Standing::seed}).standing,
            Standing::memory);
}

TEST(Standing, MemoryAndOwnChoiceAreNotVerified) {
  for (const Standing standing : kStandings) {
    EXPECT_EQ(is_verified(standing), standing != Standing::memory && standing != Standing::own);
  }
}

}  // namespace
}  // namespace fieldproof::judge
