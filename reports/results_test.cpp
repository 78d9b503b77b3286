#include "reports/results.hpp"

#include <gtest/gtest.h>

#include "reports/sample_run.hpp"

namespace fieldproof::reports {
namespace {

using judge::Verdict;

TEST(Results, CountsHaveDenominators) {
  const Counts counts = count(sample_run());
  EXPECT_EQ(counts.selected, 8U);
  EXPECT_EQ(counts.judged, 5U);
  EXPECT_EQ(counts.of(Verdict::fail), 1U);
  EXPECT_EQ(counts.of(Verdict::not_applicable), 1U);
  EXPECT_EQ(counts.not_run(), 2U);
}

TEST(Results, HeadlineIsTheHeaviestVerdict) {
  EXPECT_EQ(headline(reports::Run{}), Verdict::none);
  EXPECT_EQ(headline(sample_run()), Verdict::error);
  reports::Run run;
  run.cases = {sample_case("a", Verdict::pass), sample_case("b", Verdict::not_applicable)};
  EXPECT_EQ(headline(run), Verdict::pass);
  // What was not judged may fail.
  run.identity.incomplete_because = "interrupted";
  EXPECT_EQ(headline(run), Verdict::inconclusive);
}

TEST(Results, ReproduceCommandIsForAShell) {
  RunIdentity identity;
  EXPECT_EQ(reproduce_command(identity, "a/b"), "fieldproof run a/b");
  identity.reproduce_options = "--seed 7";
  EXPECT_EQ(reproduce_command(identity, "a b'c"), "fieldproof run 'a b'\\''c' --seed 7");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(shell_quoted("slave@3=mutant:x"), "slave@3=mutant:x");
  EXPECT_EQ(shell_quoted("interbus/**"), "'interbus/**'");
}

}  // namespace
}  // namespace fieldproof::reports
