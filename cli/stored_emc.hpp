// `replay` and `shrink` of a stored test of `emc`.
#pragma once

#include <filesystem>

#include "cli/verbs.hpp"

namespace fieldproof::cli {

// Each gives the exit code. What is shrunk is written to `file`, also when it is interrupted.
int replay_emc(Session& session);
int shrink_emc(Session& session, const std::filesystem::path& file);

}  // namespace fieldproof::cli
