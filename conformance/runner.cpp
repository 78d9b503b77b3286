#include "conformance/runner.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>
#include <utility>

#include "conformance/ordered_work.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
#include "harness/segment/stop.hpp"

namespace fieldproof::conformance {
namespace {

using judge::Verdict;

judge::CaseResult blank_result(const TestCase& test_case, Verdict verdict, std::string reason) {
  judge::CaseResult result;
  result.id = test_case.id;
  result.purpose = test_case.purpose;
  result.verdict = verdict;
  result.reason = std::move(reason);
  result.requirement = test_case.requirement;
  result.reference = test_case.reference;
  return result;
}

// The sentence why nothing is to be judged, if so.
std::optional<std::string> excluded_by_setup(const TestCase& test_case, const Setup& setup) {
  const std::string role = test_case.role();
  std::set<std::string> assigned;
  for (const Assignment& assignment : setup.implementations) {
    if (assignment.role.empty() || assignment.role == role) return std::nullopt;
    if (std::ranges::find(test_case.parts, assignment.role) != test_case.parts.end()) return std::nullopt;
    assigned.insert(assignment.role);
  }
  if (assigned.empty()) return std::nullopt;
  return fmt::format("the implementation under test is a {}, this case judges a {}",
                     fmt::join(assigned, " and a "), role);
}

// A setup that excludes a case need not fit it, so that is looked at first.
std::optional<std::string> not_applicable(const Entry& entry, const Setup& setup) {
  if (auto reason = excluded_by_setup(*entry.test_case, setup)) return reason;
  if (!entry.test_case->not_applicable) return std::nullopt;
  const std::optional<judge::Pics> pics = entry.suite->declared_pics(*entry.test_case, setup);
  return pics ? entry.test_case->not_applicable(*pics) : std::nullopt;
}

// A verdict about the run of a case, not about the implementation.
Outcome of_the_bench(const TestCase& test_case, Verdict verdict, std::string_view reason,
                     std::string_view requirement, std::string_view what) {
  Outcome outcome;
  outcome.result = blank_result(test_case, verdict, std::string(reason));
  judge::Finding finding;
  finding.verdict = verdict;
  finding.reason = reason;
  finding.requirement = requirement;
  finding.reference = {.source = "fieldproof itself", .clause = "", .standing = judge::Standing::own};
  finding.expected = {"a verdict about the implementation"};
  finding.actual = what;
  outcome.result.findings.push_back(std::move(finding));
  return outcome;
}

Outcome internal_error(const TestCase& test_case, std::string_view what) {
  return of_the_bench(test_case, Verdict::error, kInternalError, "the bench runs a case to its end", what);
}

Outcome guarded_run(const Entry& entry, const Setup& setup, const RunOptions& manner) {
  const kernel::CheckContext context(
      [&] { return fmt::format("case {}, seed {}", entry.test_case->id, setup.seed); });
  try {
    if (manner.reset) {
      if (const auto why_not = manner.reset(*entry.test_case)) {
        return of_the_bench(*entry.test_case, Verdict::inconclusive, kResetFailed,
                            "the implementation is reset before a case", *why_not);
      }
    }
    return entry.suite->run(*entry.test_case, setup);
  } catch (const kernel::Error&) {
    throw;
  } catch (const segment::Interrupted&) {
    Outcome given_up;
    given_up.result = blank_result(*entry.test_case, Verdict::none, "");
    return given_up;
  } catch (const std::exception& failure) {
    return internal_error(*entry.test_case, failure.what());
  } catch (...) {
    return internal_error(*entry.test_case, "something that is no std::exception was thrown");
  }
}

bool needs_recording(Verdict verdict) {
  return verdict != Verdict::pass && verdict != Verdict::not_applicable && verdict != Verdict::none;
}

std::uint64_t microseconds_since(std::chrono::steady_clock::time_point begin) {
  const auto passed = std::chrono::steady_clock::now() - begin;
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(passed).count());
}

bool is_same_verdict(const judge::CaseResult& one, const judge::CaseResult& other) {
  return one.verdict == other.verdict && one.reason == other.reason;
}

// A failure of real parts may be one of the moment: what does not come again each time is a doubt. All that
// was seen of it is kept.
void doubt(CaseRun& done, unsigned repetition, const judge::CaseResult& again) {
  judge::CaseResult& first = done.outcome.result;
  const std::string what =
      fmt::format("it failed with '{}', and its repetition {} gave {}{}", first.reason, repetition,
                  judge::name(again.verdict), again.reason.empty() ? "" : ", '" + again.reason + "'");
  Outcome of_doubt = of_the_bench(*done.entry.test_case, Verdict::inconclusive, kNotConfirmed,
                                  "a failure comes again when its case is repeated", what);
  for (judge::Finding& finding : first.findings) finding.verdict = Verdict::inconclusive;
  first.findings.insert(first.findings.begin(), std::move(of_doubt.result.findings.front()));
  first.verdict = Verdict::inconclusive;
  first.reason = kNotConfirmed;
}

// A repetition was interrupted: what it would have said nobody knows.
void give_up(CaseRun& done) {
  done.outcome.result.verdict = Verdict::none;
}

bool is_failure(Verdict verdict) {
  return verdict == Verdict::fail || verdict == Verdict::error;
}

// A case that was never begun has nothing to repeat.
void confirm(CaseRun& done, const RunOptions& manner) {
  const judge::CaseResult& first = done.outcome.result;
  if (!is_failure(first.verdict) || first.reason == kResetFailed) return;
  Setup unrecorded = done.setup;
  unrecorded.record = false;
  unrecorded.explains = false;
  for (unsigned repetition = 1; repetition <= manner.confirmations; ++repetition) {
    const judge::CaseResult again = guarded_run(done.entry, unrecorded, manner).result;
    if (again.verdict == Verdict::none) return give_up(done);
    if (!is_same_verdict(first, again)) return doubt(done, repetition, again);
    done.is_repeatable = done.is_repeatable && again.fingerprint == first.fingerprint;
  }
}

}  // namespace

std::uint64_t case_seed(std::uint64_t run_seed, std::string_view id) {
  return kernel::Random(run_seed).split(id).seed();
}

CaseRun run_case(const Entry& entry, const Setup& run_setup, const RunOptions& manner) {
  CaseRun done{entry, run_setup, {}, true};
  done.setup.seed = case_seed(run_setup.seed, entry.test_case->id);
  done.setup.as_device = true;
  done.setup.record = manner.keeps_recordings != KeptRecordings::none;
  const auto begin = std::chrono::steady_clock::now();
  if (auto reason = not_applicable(entry, done.setup)) {
    done.outcome.result = blank_result(*entry.test_case, Verdict::not_applicable, std::move(*reason));
  } else {
    done.outcome = guarded_run(entry, done.setup, manner);
    if (manner.keeps_recordings == KeptRecordings::failed && !needs_recording(done.outcome.result.verdict))
      done.outcome.recording = {};
    confirm(done, manner);
  }
  done.outcome.result.seed = done.setup.seed;
  done.outcome.result.wall_time_us = microseconds_since(begin);
  return done;
}

void check_setup(std::span<const Entry> entries, const Setup& setup) {
  std::set<std::pair<const Suite*, std::string>> asked;
  for (const Entry& entry : entries) {
    if (excluded_by_setup(*entry.test_case, setup)) continue;
    if (asked.insert({entry.suite, entry.test_case->role()}).second) {
      entry.suite->check(*entry.test_case, setup);
    }
  }
}

std::size_t run(const Plan& plan) {
  OrderedWork<CaseRun> work;
  work.count = plan.entries.size();
  work.threads = plan.jobs;
  work.stop = plan.stop;
  work.work = [&](std::size_t i) {
    const segment::StopScope scope(plan.stop);
    return run_case(plan.entries[i], plan.setup, plan.manner);
  };
  std::size_t handed_over = 0;
  work.deliver = [&](std::size_t, CaseRun&& done) {
    // A case that was given up has no verdict.
    if (done.outcome.result.verdict == Verdict::none) return false;
    ++handed_over;
    return plan.on_case(std::move(done));
  };
  work.idle = plan.on_progress;
  work.run();
  return handed_over;
}

}  // namespace fieldproof::conformance
