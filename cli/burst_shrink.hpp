// `shrink` of a stored case that fails under bursts: from all that they struck to the fewest bits that make
// it fail for the same reason.
#pragma once

#include <filesystem>

#include "cli/case_file.hpp"
#include "cli/verbs.hpp"

namespace fieldproof::cli {

// Writes the smaller case to `file` and its plan beside it. Gives the exit code.
int shrink_bursts(Session& session, const CaseFile& stored, const std::filesystem::path& file);

}  // namespace fieldproof::cli
