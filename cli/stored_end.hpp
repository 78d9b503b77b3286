// How a stored case ended, and whether one that was run again ended likewise.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

#include "cli/terminal.hpp"
#include "harness/config/document.hpp"
#include "harness/judge/finding.hpp"

namespace fieldproof::cli {

struct StoredEnd {
  judge::Verdict verdict = judge::Verdict::none;
  std::string reason;
  std::uint64_t fingerprint = 0;
};

StoredEnd end_of(const judge::CaseResult& result);

// The members "verdict", "reason" and "fingerprint" of a file.
void add_end(nlohmann::ordered_json& file, const StoredEnd& end);
StoredEnd end_from(config::ObjectReader& reader);

// Tells what is not as it was, or that all is; nothing can be said when another implementation took its part.
// Gives the exit code; `code` is that of the verdicts alone.
int compared(Terminal& terminal, const StoredEnd& stored, const judge::CaseResult& now, bool is_other,
             int code);

}  // namespace fieldproof::cli
