#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "conformance/judging.hpp"
#include "conformance/test_case.hpp"

// What cases that run on a bench of their protocol have in common: a procedure on a bench that is made for
// one run, chapters of cases, and a canary after them.
namespace fieldproof::conformance {

inline constexpr std::size_t kAllOfFamily = ~std::size_t{0};

// Sequences that a case is about, and how one is run.
template <typename Bench>
struct SequenceFamily {
  std::function<std::vector<Sequence>(kernel::Random random)> all;
  std::size_t quick;  // how many of them a run takes, others with each seed
  std::size_t full;
  std::function<void(const Sequence&, Bench&, CaseJudge&)> run;
};

template <typename Bench, typename Needs>
struct BenchCase {
  using BenchType = Bench;

  TestCase test_case;
  std::function<void(Bench&, CaseJudge&)> procedure;
  Needs needs{};
  // In which an IUT drives when it is asked, where those of the case do not let it; absent: they do.
  std::optional<Needs> asked_with{};
  // Absent: it has a procedure. Each sequence on a bench of its own, as those that are derived.
  std::optional<std::vector<SequenceFamily<Bench>>> families{};
};

// The same case, asked with these.
template <typename Case>
Case asked_with(decltype(Case::needs) others, Case one) {
  one.asked_with = std::move(others);
  return one;
}

// Of cases that take the bench as it is.
struct NoNeeds {};

// What is judged after a procedure, whatever it was about.
template <typename Bench>
void judge_end(Bench& bench, CaseJudge& judge) {
  bench.line_watch().judge(judge);
  bench.finish();
}

// One run on a bench of its own. The result has verdict, findings, measurements, seed, fingerprint and
// virtual time; wall time is the caller's to fill.
template <typename Bench, typename Needs, typename Setting>
judge::CaseResult run_on_bench(const BenchCase<Bench, Needs>& one, const Setting& setting) {
  // Made within the procedure: what an implementation does when it is powered is its verdict, too.
  std::optional<Bench> bench;
  CaseJudge judge(one.test_case);
  judge.use_clock([&] { return bench ? bench->segment().now() : kernel::kStart; });
  if constexpr (requires { bench->decode_lines(kernel::kStart); }) {
    judge.use_decode(
        [&](kernel::Time time) { return bench ? bench->decode_lines(time) : std::vector<std::string>{}; });
  } else if constexpr (requires { bench->decode_lines(); }) {
    judge.use_decode(
        [&](kernel::Time) { return bench ? bench->decode_lines() : std::vector<std::string>{}; });
  }
  judge::CaseResult result = judge.run_procedure([&](CaseJudge& j) {
    bench.emplace(one.needs, setting);
    j.use_steps(
        [&](const std::string& text) { bench->segment().trace().step(bench->segment().now(), text); });
    one.procedure(*bench, j);
    j.begin_step("");
    judge_end(*bench, j);
  });
  result.seed = setting.seed;
  if (!bench) return result;
  result.fingerprint = bench->segment().trace().fingerprint();
  result.has_driven = bench->line_watch().has_seen();
  result.virtual_time = bench->segment().now() - kernel::kStart;
  if constexpr (requires { bench->planned_hits(); }) result.planned_hits = bench->planned_hits();
  return result;
}

// A pass in which the IUT has driven nothing rests on this: asked on a bench of its own, it drives. Without
// that silence proves nothing, and the case is inconclusive. Only for a bench that cannot ask, too.
template <typename Bench, typename Needs, typename Setting>
void require_driven(const BenchCase<Bench, Needs>& one, Setting setting, judge::CaseResult& result) {
  const bool has_passed = result.verdict == judge::Verdict::pass || result.verdict == judge::Verdict::warn;
  if (!has_passed || result.has_driven) return;
  setting.make_recorder = nullptr;
  if constexpr (requires { setting.plan = {}; }) setting.plan = {};
  std::optional<Bench> bench;
  CaseJudge judge(one.test_case);
  judge.use_clock([&] { return bench ? bench->segment().now() : kernel::kStart; });
  const judge::CaseResult asked = judge.run_procedure([&](CaseJudge& j) {
    bench.emplace(one.asked_with.value_or(one.needs), setting);
    if constexpr (requires { bench->ask(); }) bench->ask();
    if (!bench->line_watch().has_seen()) {
      j.inconclusive("precondition_not_met", {{"an implementation that drives its line when it is asked"},
                                              "it has driven nothing in the case, nor when it was asked"});
    }
    bench->finish();
  });
  if (asked.verdict == judge::Verdict::pass) return;
  result.verdict = asked.verdict;
  result.reason = asked.reason;
  result.reference = asked.reference;
  result.findings = asked.findings;
}

// The cases of the chapters, each resting on these details too.
template <typename Case>
std::vector<Case> cases_of(std::span<std::vector<Case> (*const)()> chapters,
                           const std::vector<PartialSource>& details) {
  std::vector<Case> all;
  for (const auto chapter : chapters) {
    for (Case& one : chapter()) {
      rest_also_on(one.test_case, details);
      all.push_back(std::move(one));
    }
  }
  return all;
}

// Asks for what no implementation of the role does, in any suite. `reference` is the suite's own.
inline TestCase canary_of(const std::string& role, judge::Reference reference, std::string stimulus,
                          std::string expected) {
  TestCase test_case;
  test_case.id = role + "/canary/a_failure_is_seen";
  test_case.purpose = "canary";
  test_case.requirement = "a failure of this suite is seen";
  test_case.reference = std::move(reference);
  test_case.stimulus = std::move(stimulus);
  test_case.expected = "The verdict is fail: " + std::move(expected);
  test_case.tags = {"canary"};
  return test_case;
}

}  // namespace fieldproof::conformance
