#include "cli/exit_code.hpp"

#include <algorithm>

#include "conformance/runner.hpp"

namespace fieldproof::cli {

int exit_code(const reports::Run& run, const ExitRules& rules) {
  using judge::Verdict;
  const bool has_internal_error =
      std::any_of(run.cases.begin(), run.cases.end(), [](const judge::CaseResult& result) {
        return result.verdict == Verdict::error && result.reason == conformance::kInternalError;
      });
  if (has_internal_error) return kInternal;
  if (rules.signal != 0) return kSignalBase + rules.signal;
  const auto count_of = [&](Verdict verdict) {
    return std::ranges::count(run.cases, verdict, reports::counted_verdict);
  };
  const auto doubtful = count_of(Verdict::inconclusive);
  auto failed = count_of(Verdict::fail) + count_of(Verdict::error);
  if (rules.is_strict) failed += doubtful + count_of(Verdict::warn);
  if (failed > 0) return kFailed;
  if (rules.differs || rules.is_stale) return kDiffers;
  if (reports::count(run).judged == 0) return kNothingJudged;
  if ((doubtful > 0 || rules.is_incomplete) && !rules.allows_inconclusive) return kInconclusive;
  return kAllAsExpected;
}

}  // namespace fieldproof::cli
