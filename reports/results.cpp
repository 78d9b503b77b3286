#include "reports/results.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

namespace fieldproof::reports {

std::size_t Counts::not_run() const {
  const std::size_t decided = judged + of(judge::Verdict::not_applicable);
  return selected > decided ? selected - decided : 0;
}

Counts count(const Run& run) {
  Counts counts;
  // An interrupted run knows of more cases than it judged, a partial model of fewer than it holds.
  counts.selected = std::max(run.identity.selected, run.cases.size());
  for (const judge::CaseResult& result : run.cases) {
    ++counts.by_verdict.at(static_cast<std::size_t>(result.verdict));
    if (result.verdict >= judge::Verdict::pass) ++counts.judged;
    if (counted_verdict(result) != result.verdict) ++counts.expected;
  }
  return counts;
}

judge::Verdict counted_verdict(const judge::CaseResult& result) {
  const bool is_expected = result.verdict > judge::Verdict::pass && !result.expected_because.empty();
  return is_expected ? judge::Verdict::pass : result.verdict;
}

judge::Verdict headline(const Run& run) {
  // What was not judged may fail.
  judge::Verdict heaviest = run.is_complete() ? judge::Verdict::none : judge::Verdict::inconclusive;
  for (const judge::CaseResult& result : run.cases) heaviest = std::max(heaviest, counted_verdict(result));
  return heaviest;
}

std::size_t unverified_verdicts(const Run& run) {
  return static_cast<std::size_t>(std::ranges::count_if(run.cases, [](const judge::CaseResult& result) {
    return result.verdict >= judge::Verdict::pass && !judge::is_verified(result.reference.standing);
  }));
}

std::vector<PlannedFault> planned_faults(const Run& run) {
  std::vector<PlannedFault> faults;
  for (const fault::PlanPart& part : run.identity.plan) faults.push_back({.part = part});
  for (const judge::CaseResult& result : run.cases) {
    for (std::size_t n = 0; n < std::min(faults.size(), result.planned_hits.size()); ++n) {
      const std::uint64_t hits = result.planned_hits[n];
      faults[n].hits += std::min(hits, std::numeric_limits<std::uint64_t>::max() - faults[n].hits);
      faults[n].cases_hit += hits > 0 ? 1 : 0;
      ++faults[n].cases;
    }
  }
  return faults;
}

std::string reproduce_command(const RunIdentity& identity, const std::string& case_id) {
  std::string command = "fieldproof run " + shell_quoted(case_id);
  if (!identity.reproduce_options.empty()) command += " " + identity.reproduce_options;
  return command;
}

std::string shell_quoted(const std::string& word) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string(R"('\'')") : std::string(1, c);
  return quoted + "'";
}

}  // namespace fieldproof::reports
