// The files of `--json`, `--junit`, `--sarif`, `--ctrf` and `--html`: a run in the formats that others read.
#pragma once

#include "cli/verbs.hpp"
#include "reports/outcome.hpp"
#include "reports/page_content.hpp"

namespace fieldproof::cli {

// Refuses what cannot be written, before hours of work that its absence would make worthless.
void check_copies(const Settings& settings);

// Whether a copy of a run is asked for besides the page.
bool asks_for_copies(const Settings& settings);

// What a server shows tells the same as the exit code.
reports::OutcomeRules outcome_rules(const Settings& settings);

// Also what `--github` prints, and adds to the file that GITHUB_STEP_SUMMARY names.
void write_copies(const Session& session, const reports::PageRun& run, const reports::OutcomeRules& rules);

}  // namespace fieldproof::cli
