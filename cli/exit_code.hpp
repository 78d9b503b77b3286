// What the program tells its caller by its exit code; the first that applies, never a count.
#pragma once

#include "reports/results.hpp"

namespace fieldproof::cli {

inline constexpr int kAllAsExpected = 0;
inline constexpr int kFailed = 1;
inline constexpr int kInconclusive = 2;
inline constexpr int kDiffers = 3;  // a fingerprint differed, or the baseline is stale
inline constexpr int kNothingJudged = 4;
inline constexpr int kUsage = 64;
inline constexpr int kInternal = 70;
inline constexpr int kResultLost = 74;  // would be 0, but standard output took not all of the result
inline constexpr int kSignalBase = 128;

struct ExitRules {
  bool is_strict = false;  // warn and inconclusive count as fail
  bool allows_inconclusive = false;
  bool is_incomplete = false;  // not all that was selected is judged; counts as inconclusive
  bool is_stale = false;       // the baseline says what is not so any more
  bool differs = false;        // a fingerprint or a stored verdict was not met again
  int signal = 0;
};

// 70 before a signal before 1, 3, 2, 4, 0: an interrupted run says so even when cases failed until then,
// because the rest of them is unknown.
int exit_code(const reports::Run& run, const ExitRules& rules);

}  // namespace fieldproof::cli
