// Subject: what a run is told besides its cases: the failures that are expected, how often one must come
// again, which part of a selection is meant, and how the implementation is reset in between.
#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <string>

#include "cli/baseline.hpp"
#include "cli/probe/probe_fixture.hpp"
#include "cli/reset_hook.hpp"

namespace fieldproof::cli {
namespace {

class AcceptedFailures : public Program {
 protected:
  // A baseline of one entry.
  void expect_of(const std::string& id, const std::string& more = "") const {
    write("baseline.json", R"({"expected": [{"case": ")" + id + R"(", "reason": "board <B>")" + more + "}]}");
  }
  Called run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"--baseline", "baseline.json", "--out", "r", "--junit", "r.xml"});
    const Called called = probe(std::move(arguments));
    return called;
  }
};

constexpr const char* kLater = R"(, "expires": "2999-12-31")";
constexpr const char* kPast = R"(, "expires": "2020-12-31")";

TEST_F(AcceptedFailures, ExpectedOneIsToldAndDoesNotFailTheRun) {
  expect_of("odd/end/fails", kLater);
  const Called called = run({"odd/end/fails", "probe/**"});
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
  EXPECT_HOLDS(called.out, "(always), expected: board <B>, until 2999-12-31");
  EXPECT_HOLDS(called.out, "1 expected by the baseline");
  EXPECT_HOLDS(read("r.xml"), "<skipped message=\"expected: board &lt;B&gt;, until 2999-12-31\"/>");
  EXPECT_EQ(json("r/results.json")["headline"], "pass");
  EXPECT_EQ(json("r/results.json")["counts"]["expected"], 1);
  expect_valid({"r/results.json"}, "results");
}

TEST_F(AcceptedFailures, OtherFailuresStillFailTheRun) {
  expect_of("odd/end/is_inconclusive", kLater);
  EXPECT_EQ(run({"odd/end/is_inconclusive", "odd/end/fails"}).exit_code, 1);
}

TEST_F(AcceptedFailures, InconclusiveOneMayBeExpectedToo) {
  expect_of("odd/end/is_inconclusive", kLater);
  EXPECT_EQ(run({"odd/end/is_inconclusive"}).exit_code, 0);
}

TEST_F(AcceptedFailures, AnotherReasonThanTheNamedOneFails) {
  expect_of("odd/end/fails", std::string(kLater) + R"(, "finding": "never")");
  const Called called = run({"odd/end/fails"});
  EXPECT_EQ(called.exit_code, 1);
  EXPECT_HOLDS(called.out, "odd/end/fails is accepted for 'never' and has 'always'");
}

TEST_F(AcceptedFailures, ExpiredEntryFails) {
  expect_of("odd/end/fails", kPast);
  const Called called = run({"odd/end/fails"});
  EXPECT_EQ(called.exit_code, 1);
  EXPECT_HOLDS(called.out, "odd/end/fails was accepted until 2020-12-31");
}

TEST_F(AcceptedFailures, CaseThatPassesMakesTheBaselineStale) {
  expect_of("probe/station/data/word_is_latched", kLater);
  const Called called = run({"probe/**"});
  EXPECT_EQ(called.exit_code, 3) << called.out;
  EXPECT_HOLDS(called.out, "baseline: ");
  EXPECT_HOLDS(called.out, "word_is_latched passes; remove the entry");
  EXPECT_HOLDS(read("r.xml"), "name=\"baseline_is_current\"");
  EXPECT_HOLDS(read("r.xml"), "failures=\"1\"");
  EXPECT_EQ(json("r/results.json")["run"]["stale_expectations"].size(), 1U);
}

TEST_F(AcceptedFailures, CaseThatDoesNotApplyIsStaleAndOneThatIsNotSelectedIsNot) {
  expect_of("odd/end/does_not_apply", kLater);
  EXPECT_EQ(run({"odd/end/does_not_apply", "odd/end/warns"}).exit_code, 3);
  std::filesystem::remove_all(folder_ / "r");
  EXPECT_EQ(run({"odd/end/warns"}).exit_code, 0);
}

TEST_F(AcceptedFailures, UnknownCaseIsRefusedBeforeAnythingIsStored) {
  expect_of("odd/end/fail", kLater);
  const Called called = run({"odd/end/fails"});
  EXPECT_EQ(called.exit_code, 65);
  EXPECT_HOLDS(called.err,
               "baseline.json:1: /expected/0/case: there is no such case; the nearest is \"odd/end/fails\"");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "r"));
}

TEST_F(AcceptedFailures, BrokenInvariantIsNeverExpected) {
  expect_of("odd/end/breaks", kLater);
  EXPECT_EQ(run({"odd/end/breaks"}).exit_code, 70);
}

TEST_F(AcceptedFailures, RunOfTheFailedOnesLeavesOutTheExpected) {
  expect_of("odd/end/fails", kLater);
  EXPECT_EQ(run({"odd/end/fails", "odd/end/is_inconclusive"}).exit_code, 2);
  const Called again = probe({"run", "--failed=r"});
  EXPECT_HOLDS(again.err, "1 of the cases of r did not pass");
}

// The baseline of now decides, also about what was judged before.
TEST_F(AcceptedFailures, ResumedRunIsHeldAgainstTheBaselineOfNow) {
  expect_of("odd/end/fails", kLater);
  EXPECT_EQ(run({"odd/end/fails", "odd/end/warns", "--max-time", "1h"}).exit_code, 0);
  expect_of("odd/end/warns", kLater);
  EXPECT_EQ(probe({"run", "--resume", "r"}).exit_code, 1);
}

using Confirmation = Program;

TEST_F(Confirmation, FailureThatComesAgainStaysOne) {
  EXPECT_EQ(code({"run", "odd/end/fails", "--confirm", "3"}), 1);
}

TEST_F(Confirmation, RecordingIsARepetitionAsWell) {
  const Called called = probe({"run", "odd/end/fails_once", "--confirm", "2"});
  EXPECT_EQ(called.exit_code, 2) << called.out << called.err;
  EXPECT_HOLDS(called.out, "its repetition 1 gave pass");
}

TEST_F(Confirmation, FailureThatDoesNotIsInconclusiveAndKeepsWhatWasSeen) {
  EXPECT_EQ(code({"run", "odd/end/fails_once", "--record", "none", "--out", "once"}), 1);
  const Called called =
      probe({"run", "odd/end/fails_once", "--record", "none", "--confirm", "2", "--out", "r"});
  EXPECT_EQ(called.exit_code, 2) << called.out;
  EXPECT_HOLDS(called.out, "(not_confirmed)");
  EXPECT_HOLDS(called.out, "it failed with 'first_time', and its repetition 1 gave pass");
  EXPECT_EQ(json("r/results.json")["cases"][0]["findings"].size(), 2U);
}

using Shard = Program;

TEST_F(Shard, PartsAreTheWholeAndEachCaseIsInOne) {
  const auto ids_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"list", "probe/**", "odd/slow/**"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    std::set<std::string> ids;
    std::istringstream lines(probe(arguments).out);
    for (std::string line; std::getline(lines, line);) ids.insert(line);
    return ids;
  };
  const std::set<std::string> whole = ids_of({});
  std::set<std::string> all;
  std::size_t count = 0;
  for (const char* part : {"1/3", "2/3", "3/3"}) {
    const std::set<std::string> ids = ids_of({"--shard", part});
    EXPECT_NEAR(static_cast<double>(ids.size()), static_cast<double>(whole.size()) / 3, 1);
    count += ids.size();
    all.insert(ids.begin(), ids.end());
  }
  EXPECT_EQ(all, whole);
  EXPECT_EQ(count, whole.size());
}

TEST_F(Shard, OtherWordsAreRefused) {
  for (const char* part : {"0/3", "4/3", "1", "1/", "/3", "a/3", "1/3x", "-1/3"}) {
    EXPECT_EQ(code({"run", "probe/**", "--shard", part}), 64) << part;
  }
  EXPECT_EQ(code({"run", "--failed", "--shard", "1/2"}), 64);
}

// What a part of a whole has selected stays selected.
TEST_F(Shard, ResumedAndFailedRunsKeepTheirSelection) {
  EXPECT_EQ(code({"run", "odd/end/fails", "odd/slow/**", "--shard", "1/2", "--out", "a"}), 1);
  const std::size_t failed = json("a/results.json")["counts"]["by_verdict"]["fail"];
  EXPECT_EQ(code({"run", "--resume", "a", "--shard", "2/2"}), 64);
  EXPECT_EQ(code({"run", "--failed=a", "--fail-fast", "--out", "b"}), 1);
  EXPECT_EQ(code({"run", "--resume", "b"}), 1);
  EXPECT_EQ(json("b/results.json")["counts"]["judged"], failed);
  EXPECT_EQ(json("b/results.json")["counts"]["not_run"], 0);
}

using Reset = Program;

TEST_F(Reset, CommandRunsBeforeEachCaseWithItsId) {
  const Called called = probe({"run", "probe/**", "--reset", "echo \"$1\" >> ids", "--jobs", "2"});
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
  EXPECT_HOLDS(read("ids"), "probe/station/data/word_is_latched\n");
  const std::string ids = read("ids");
  EXPECT_EQ(std::count(ids.begin(), ids.end(), '\n'), std::stol(probe({"list", "probe/**", "--count"}).out));
}

TEST_F(Reset, FailureLeavesTheCaseInconclusiveWithWhatWasSaid) {
  const Called called = probe({"run", "probe/**", "--reset", "echo relay is gone; exit 3"});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_HOLDS(called.out, "(reset_failed)");
  EXPECT_HOLDS(called.out, "ended with exit code 3, and said: relay is gone");
}

TEST(ResetHook, ThatNeverEndsIsEnded) {
  conformance::TestCase test_case;
  test_case.id = "a/b/c";
  const auto hook = reset_hook("sleep 1000", std::chrono::milliseconds(200));
  EXPECT_EQ(hook(test_case), "'sleep 1000' has not ended within 200 ms");
}

TEST(ResetHook, ThatSaysALotIsHeardToItsEnd) {
  conformance::TestCase test_case;
  test_case.id = "a/b/c";
  const auto hook = reset_hook("seq 1 100000; exit 1", std::chrono::seconds(20));
  const std::optional<std::string> said = hook(test_case);
  ASSERT_TRUE(said);
  EXPECT_LT(said->size(), 3000U);
}

}  // namespace
}  // namespace fieldproof::cli
