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

template <typename Bench, typename Needs>
struct BenchCase {
  using BenchType = Bench;

  TestCase test_case;
  std::function<void(Bench&, CaseJudge&)> procedure;
  Needs needs{};
};

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
  if constexpr (requires { bench->decode_lines(); }) {
    judge.use_decode([&] { return bench ? bench->decode_lines() : std::vector<std::string>{}; });
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
