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
  const reports::Counts counts = reports::count(run);
  const std::size_t doubtful = counts.of(Verdict::inconclusive);
  std::size_t failed = counts.of(Verdict::fail) + counts.of(Verdict::error);
  if (rules.is_strict) failed += doubtful + counts.of(Verdict::warn);
  if (failed > 0) return kFailed;
  if (rules.differs) return kDiffers;
  if (counts.judged == 0) return kNothingJudged;
  if ((doubtful > 0 || rules.is_incomplete) && !rules.allows_inconclusive) return kInconclusive;
  return kAllAsExpected;
}

}  // namespace fieldproof::cli
