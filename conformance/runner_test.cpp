#include "conformance/runner.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <thread>

#include "conformance/ordered_work.hpp"
#include "conformance/suite_of_functions.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

using judge::Verdict;

Outcome outcome_of(Verdict verdict, const conformance::Setup& setup, std::string reason = {}) {
  Outcome outcome;
  outcome.result.verdict = verdict;
  outcome.result.reason = std::move(reason);
  outcome.result.fingerprint = setup.seed * 31;
  if (setup.record) {
    outcome.recording.trace.channels = {"a"};
    outcome.recording.trace.records = {trace::Observation{0, kernel::kStart, "first", 1},
                                       trace::Fault{0, kernel::kStart, "second"}};
  }
  return outcome;
}

// Twelve cases that end in another order than they begin; before the seventh and the later ones begin their
// work, `wait` is called.
Catalogue twelve_cases(const std::function<void()>& wait = [] {}) {
  auto suite = std::make_unique<SuiteOfFunctions>("ring", std::vector<std::string>{"slave", "master"});
  for (int i = 0; i < 12; ++i) {
    TestCase test_case;
    test_case.id = fmt::format("ring/{}/case_{}", i < 10 ? "slave" : "master", i);
    test_case.requirement = "a requirement";
    suite->add(std::move(test_case), [i, wait](const TestCase&, const conformance::Setup& setup) {
      if (i >= 6) wait();
      std::this_thread::sleep_for(std::chrono::microseconds((13 - i) * 300));
      if (i == 3) return outcome_of(Verdict::fail, setup, "three");
      return outcome_of(Verdict::pass, setup);
    });
  }
  std::vector<std::unique_ptr<Suite>> suites;
  suites.push_back(std::move(suite));
  return Catalogue(std::move(suites));
}

Catalogue single(SuiteOfFunctions::Function function) {
  auto suite = std::make_unique<SuiteOfFunctions>("ring", std::vector<std::string>{"slave", "master"});
  TestCase test_case;
  test_case.id = "ring/slave/only";
  test_case.not_applicable = [](const judge::Pics& pics) -> std::optional<std::string> {
    if (pics.supports("only")) return std::nullopt;
    return "the implementation has no 'only'";
  };
  suite->add(std::move(test_case), std::move(function));
  std::vector<std::unique_ptr<Suite>> suites;
  suites.push_back(std::move(suite));
  return Catalogue(std::move(suites));
}

std::vector<std::string> results(const Catalogue& catalogue, unsigned jobs) {
  std::vector<std::string> lines;
  Plan plan;
  plan.entries = catalogue.entries();
  plan.setup.seed = 7;
  plan.jobs = jobs;
  plan.on_case = [&](CaseRun&& done) {
    const judge::CaseResult& result = done.outcome.result;
    lines.push_back(
        fmt::format("{} {} {} {}", result.id, judge::name(result.verdict), result.seed, result.fingerprint));
    return true;
  };
  EXPECT_EQ(run(plan), catalogue.entries().size());
  return lines;
}

TEST(RunnerThreads, HandOverInCatalogueOrderWhateverTheirNumber) {
  const Catalogue catalogue = twelve_cases();
  const std::vector<std::string> alone = results(catalogue, 1);
  ASSERT_EQ(alone.size(), 12U);
  EXPECT_EQ(alone.front().substr(0, 22), "ring/slave/case_0 pass");
  EXPECT_EQ(results(catalogue, 2), alone);
  EXPECT_EQ(results(catalogue, 5), alone);
}

TEST(RunnerThreads, StopAfterTheCaseThatTheReceiverRefuses) {
  const Catalogue catalogue = twelve_cases();
  for (const unsigned jobs : {1U, 4U}) {
    std::vector<std::string> seen;
    Plan plan;
    plan.entries = catalogue.entries();
    plan.jobs = jobs;
    plan.on_case = [&](CaseRun&& done) {
      seen.push_back(done.outcome.result.id);
      return done.outcome.result.verdict != Verdict::fail;
    };
    EXPECT_EQ(run(plan), 4U);
    EXPECT_EQ(seen.back(), "ring/slave/case_3");
  }
}

TEST(RunnerThreads, StopTokenEndsTheRunWithAGaplessBeginning) {
  for (const unsigned jobs : {1U, 3U}) {
    std::stop_source source;
    // However late the first two are delivered, not all cases have run by then.
    const Catalogue catalogue = twelve_cases([&source] {
      while (!source.stop_requested()) std::this_thread::yield();
    });
    std::vector<std::string> seen;
    Plan plan;
    plan.entries = catalogue.entries();
    plan.jobs = jobs;
    plan.stop = source.get_token();
    plan.on_case = [&](CaseRun&& done) {
      seen.push_back(done.outcome.result.id);
      if (seen.size() == 2) source.request_stop();
      return true;
    };
    const std::size_t delivered = run(plan);
    EXPECT_EQ(delivered, seen.size());
    EXPECT_GE(delivered, 2U);
    EXPECT_LT(delivered, 12U);
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], catalogue.entries()[i].test_case->id);
  }
}

TEST(RunnerThreads, RequestThatCannotBeServedEndsTheRun) {
  const Catalogue catalogue = single([](const TestCase&, const conformance::Setup&) -> Outcome {
    throw kernel::Error(kernel::ErrorKind::configuration, "network.json:3: no");
  });
  Plan plan;
  plan.entries = {catalogue.entries().front(), catalogue.entries().front()};
  plan.jobs = 2;
  plan.on_case = [](CaseRun&&) { return true; };
  EXPECT_THROW(run(plan), kernel::Error);
}

TEST(Runner, SeedOfACaseDependsOnRunSeedAndIdOnly) {
  EXPECT_EQ(case_seed(7, "a/b/c"), case_seed(7, "a/b/c"));
  EXPECT_NE(case_seed(7, "a/b/c"), case_seed(8, "a/b/c"));
  EXPECT_NE(case_seed(7, "a/b/c"), case_seed(7, "a/b/d"));
  const Catalogue catalogue = twelve_cases();
  const Entry& entry = catalogue.entries()[5];
  conformance::Setup setup;
  setup.seed = 7;
  EXPECT_EQ(run_case(entry, setup).outcome.result.seed, case_seed(7, entry.test_case->id));
}

TEST(Runner, BrokenInvariantOfACaseIsAnErrorVerdictWithItsSentence) {
  const Catalogue catalogue = single([](const TestCase&, const conformance::Setup&) -> Outcome {
    FIELDPROOF_CHECK(false, "two telegrams at once");
    return {};
  });
  const judge::CaseResult result = run_case(catalogue.entries().front(), {}).outcome.result;
  EXPECT_EQ(result.verdict, Verdict::error);
  EXPECT_EQ(result.reason, kInternalError);
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_NE(result.findings[0].actual.find("two telegrams at once"), std::string::npos);
  EXPECT_NE(result.findings[0].actual.find("case ring/slave/only, seed "), std::string::npos);
}

TEST(Runner, CaseOutsideThePicsIsNotApplicableWithTheReason) {
  const Catalogue catalogue = single(
      [](const TestCase&, const conformance::Setup& setup) { return outcome_of(Verdict::pass, setup); });
  conformance::Setup setup;
  setup.pics.emplace();
  const judge::CaseResult excluded = run_case(catalogue.entries().front(), setup).outcome.result;
  EXPECT_EQ(excluded.verdict, Verdict::not_applicable);
  EXPECT_EQ(excluded.reason, "the implementation has no 'only'");
  setup.pics->declare("only", true);
  EXPECT_EQ(run_case(catalogue.entries().front(), setup).outcome.result.verdict, Verdict::pass);
}

TEST(Runner, CaseOfARoleThatNobodyWasAssignedToIsNotApplicable) {
  const Catalogue catalogue = twelve_cases();
  conformance::Setup setup;
  setup.implementations = {{"master", 0, "ref"}};
  EXPECT_EQ(run_case(catalogue.entries().front(), setup).outcome.result.verdict, Verdict::not_applicable);
  EXPECT_EQ(run_case(catalogue.entries().back(), setup).outcome.result.verdict, Verdict::pass);
  setup.implementations.push_back({"", 0, "ref"});
  EXPECT_EQ(run_case(catalogue.entries().front(), setup).outcome.result.verdict, Verdict::pass);
}

TEST(Runner, FailedCaseKeepsTheRecordingOfItsOneRun) {
  const Catalogue catalogue = twelve_cases();
  const CaseRun passed = run_case(catalogue.entries()[0], {}, {KeptRecordings::failed});
  EXPECT_TRUE(passed.outcome.recording.lines().empty());
  const CaseRun failed = run_case(catalogue.entries()[3], {}, {KeptRecordings::failed});
  EXPECT_EQ(failed.outcome.recording.lines(),
            (std::vector<std::string>{"0 s  a  first = 1", "0 s  a  fault: second"}));
  EXPECT_TRUE(failed.is_repeatable);
}

TEST(Runner, CaseThatDoesNotRepeatIsTold) {
  auto calls = std::make_shared<std::uint64_t>(0);
  const Catalogue catalogue = single([calls](const TestCase&, const conformance::Setup& setup) {
    Outcome outcome = outcome_of(Verdict::fail, setup);
    outcome.result.fingerprint = ++*calls;
    return outcome;
  });
  EXPECT_FALSE(run_case(catalogue.entries().front(), {}, {KeptRecordings::failed, 1}).is_repeatable);
}

}  // namespace
}  // namespace fieldproof::conformance
