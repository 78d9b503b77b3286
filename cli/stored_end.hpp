// How a stored case ended, and whether one that was run again ended likewise.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

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

// The file says that it is of this kind. One that cannot be read is of none.
bool has_schema(const std::filesystem::path& file, std::string_view schema);

// What a file stores of an end, beside what came now.
struct StoredAndNow {
  std::string_view what;
  std::string stored;
  std::string now;
};

// Tells what is not as it was, or that all is; nothing can be said when another implementation took its part.
// Gives the exit code; `code` is that of the verdicts alone.
int compared(Terminal& terminal, std::span<const StoredAndNow> members, bool is_other, int code);
int compared(Terminal& terminal, const StoredEnd& stored, const judge::CaseResult& now, bool is_other,
             int code);

}  // namespace fieldproof::cli
