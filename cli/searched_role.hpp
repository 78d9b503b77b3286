// What `check` and `fuzz` have in common: which role is searched, and what becomes of what was found.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "cli/exit_code.hpp"
#include "cli/interruption.hpp"
#include "cli/sequence_file.hpp"
#include "cli/verbs.hpp"
#include "conformance/sequence_check.hpp"

namespace fieldproof::cli {

inline constexpr std::uint64_t kMostSearched = 1'000'000'000;  // sequences

// The role, seed, implementations and limits that the call names.
SequenceFile searched_role(const Session& session);
// Where what is found goes.
std::string found_path(const Session& session, const SequenceFile& target);

inline constexpr std::string_view kDroveNothing =
    "; the implementation drove nothing in any of them, which shows nothing: take more sequences";

template <typename Result>
bool is_silent(const Result& result) {
  return result.passed > 0 && result.silent == result.passed;
}

template <typename Result>
int code_of_search(const Result& result) {
  if (result.passed == 0) return kNothingJudged;
  return result.inconclusive > 0 || is_silent(result) ? kInconclusive : kAllAsExpected;
}

// Stores and prints what was found; `which` is "sequence 7".
int keep_found(Session& session, SequenceFile& target, const std::string& path,
               const conformance::SequenceFound& found, const std::string& which,
               const Interruption& interruption);

}  // namespace fieldproof::cli
