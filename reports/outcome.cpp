#include "reports/outcome.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fieldproof::reports {
namespace {

using judge::Verdict;

Outcome outcome_of_verdict(Verdict verdict, const OutcomeRules& rules) {
  switch (verdict) {
    case Verdict::pass:
      return Outcome::passed;
    case Verdict::warn:
      return rules.is_strict ? Outcome::failure : Outcome::passed;
    case Verdict::fail:
      return Outcome::failure;
    case Verdict::not_applicable:
      return Outcome::skipped;
    case Verdict::inconclusive:
      if (rules.inconclusive == InconclusiveAs::failure) return Outcome::failure;
      return rules.inconclusive == InconclusiveAs::skipped ? Outcome::skipped : Outcome::error;
    case Verdict::none:
    case Verdict::error:
      break;
  }
  return Outcome::error;
}

}  // namespace

Outcome outcome_of(const judge::CaseResult& result, const OutcomeRules& rules) {
  const bool is_expected = counted_verdict(result) != result.verdict;
  return is_expected ? Outcome::skipped : outcome_of_verdict(result.verdict, rules);
}

std::string outcome_message(const judge::CaseResult& result) {
  if (result.verdict == Verdict::none) return "the case was not judged";
  if (counted_verdict(result) != result.verdict) return "expected: " + result.expected_because;
  if (result.verdict == Verdict::inconclusive) return "inconclusive: " + result.reason;
  return result.reason;
}

std::string verdict_message(const judge::CaseResult& result) {
  const std::string message = outcome_message(result);
  const std::string verdict(name(result.verdict));
  return message.starts_with(verdict + ":") ? message : verdict + ": " + message;
}

std::vector<Complaint> complaints_about(const Run& run, const OutcomeRules& rules) {
  std::vector<Complaint> all;
  if (!run.is_complete()) {
    const Counts counts = count(run);
    all.push_back({"is_complete", "incomplete",
                   fmt::format("the run is incomplete: {}; {} of {} selected cases were not judged",
                               run.identity.incomplete_because, counts.not_run(), counts.selected),
                   outcome_of_verdict(Verdict::inconclusive, rules)});
  }
  if (!run.identity.stale_expectations.empty()) {
    all.push_back({"baseline_is_current", "stale",
                   fmt::format("{}", fmt::join(run.identity.stale_expectations, "\n")), Outcome::failure});
  }
  return all;
}

}  // namespace fieldproof::reports
