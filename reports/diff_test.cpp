#include "reports/diff.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "reports/approved_text.hpp"
#include "reports/sample_run.hpp"

namespace fieldproof::reports {
namespace {

using judge::Verdict;

Run run_of(std::vector<judge::CaseResult> cases) {
  reports::Run run;
  run.cases = std::move(cases);
  return run;
}

judge::CaseResult measured(double value) {
  judge::CaseResult result = sample_case("a/measured", Verdict::pass);
  result.measurements = {{"cycle_time", "us", value, value, value}};
  return result;
}

Difference drift(double before, double after, const DriftLimits& limits) {
  return compare(run_of({measured(before)}), run_of({measured(after)}), limits);
}

TEST(Diff, FindsNothingBetweenEqualRuns) {
  reports::Run before = sample_run();
  before.identity.incomplete_because.clear();
  reports::Run again = before;
  for (judge::CaseResult& result : again.cases) result.wall_time_us = 1;
  EXPECT_TRUE(compare(before, again).is_empty());
  EXPECT_EQ(diff_text(compare(before, again)), "no difference\n");
}

TEST(Diff, SaysWhichRunIsIncomplete) {
  reports::Run whole = sample_run();
  whole.identity.incomplete_because.clear();
  const Difference difference = compare(whole, sample_run());
  ASSERT_EQ(difference.incomplete.size(), 1U);
  EXPECT_EQ(difference.incomplete.front(),
            "the second run is incomplete: interrupted by SIGINT; 2 of 8 selected cases were not judged");
  EXPECT_EQ(compare(sample_run(), sample_run()).incomplete.size(), 2U);
}

TEST(Diff, TellsEveryKindOfChangeAsApproved) {
  reports::Run before =
      run_of({sample_case("a/broken", Verdict::pass), sample_case("a/fixed", Verdict::fail, "bad"),
              sample_case("a/other", Verdict::pass), sample_case("a/gone", Verdict::pass), measured(755)});
  reports::Run after =
      run_of({sample_case("a/broken", Verdict::error, "died"), sample_case("a/fixed", Verdict::pass),
              sample_case("a/other", Verdict::inconclusive, "near"), sample_case("a/new", Verdict::fail, "r"),
              measured(814.8)});
  after.identity.seed = 2;
  after.cases.back().fingerprint = 1;
  expect_approved("diff.txt", diff_text(compare(before, after)));
  expect_approved("diff.json", diff_json(compare(before, after)));
}

TEST(Diff, AFailureThatIsNoLongerJudgedIsNotFixed) {
  const Difference difference = compare(run_of({sample_case("a", Verdict::fail)}),
                                        run_of({sample_case("a", Verdict::not_applicable, "not declared")}));
  EXPECT_TRUE(difference.fixed.empty());
  EXPECT_EQ(difference.changed.size(), 1U);
}

TEST(Diff, AFailureThatGetsHeavierIsAChange) {
  const Difference difference =
      compare(run_of({sample_case("a", Verdict::fail)}), run_of({sample_case("a", Verdict::error)}));
  EXPECT_TRUE(difference.new_failures.empty());
  EXPECT_EQ(difference.changed.size(), 1U);
}

TEST(Diff, DriftsPastBothLimits) {
  EXPECT_TRUE(drift(100, 101, {1, 0}).drifts.empty());
  EXPECT_EQ(drift(100, 101.5, {1, 0}).drifts.size(), 1U);
  EXPECT_TRUE(drift(100, 101, {0, 0.01}).drifts.empty());
  EXPECT_EQ(drift(100, 98.5, {0, 0.01}).drifts.size(), 1U);
  EXPECT_TRUE(drift(100, 101.5, {1, 0.02}).drifts.empty());
}

TEST(Diff, DriftsFromZeroAndToNoNumber) {
  const Difference difference = drift(0, 3, {1, 0.5});
  ASSERT_EQ(difference.drifts.size(), 1U);
  EXPECT_TRUE(std::isinf(difference.drifts.front().relative()));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(drift(1, kNan, {1e9, 1}).drifts.size(), 1U);
  EXPECT_TRUE(drift(kNan, kNan, {0, 0}).drifts.empty());
}

TEST(Diff, TellsDriftsInNumbersThatPeopleWrite) {
  EXPECT_NE(diff_text(drift(880.5999999999999, 900, {})).find("880.6 -> 900 us (+19.4 us, +2.203 %)"),
            std::string::npos);
  EXPECT_NE(diff_text(drift(0, 23.92, {})).find("0 -> 23.92 us (+23.92 us)\n"), std::string::npos);
}

TEST(Diff, MeasurementsOfOneNameBelongTogetherInTheirOrder) {
  judge::CaseResult before = measured(755);
  before.measurements.push_back({"cycle_time", "us", 814.8, 814.8, 814.8});
  EXPECT_TRUE(compare(run_of({before}), run_of({before})).drifts.empty());
  judge::CaseResult after = before;
  after.measurements.back().value = 829;
  const Difference difference = compare(run_of({before}), run_of({after}));
  ASSERT_EQ(difference.drifts.size(), 1U);
  EXPECT_EQ(difference.drifts.front().before, 814.8);
  after.measurements.pop_back();
  EXPECT_TRUE(compare(run_of({before}), run_of({after})).drifts.empty());
}

TEST(Diff, ListsOtherFingerprintsOfEqualSeedsOnly) {
  judge::CaseResult before = sample_case("a", Verdict::pass);
  judge::CaseResult after = before;
  after.fingerprint = 1;
  EXPECT_EQ(compare(run_of({before}), run_of({after})).fingerprints.size(), 1U);
  after.seed = 12;
  EXPECT_TRUE(compare(run_of({before}), run_of({after})).fingerprints.empty());
}

}  // namespace
}  // namespace fieldproof::reports
