// The runs of `--shard 1/N` to `N/N` as the one run that they are the parts of.
#pragma once

#include <string>
#include <vector>

#include "cli/verbs.hpp"
#include "reports/outcome.hpp"
#include "reports/page_content.hpp"
#include "reports/run_directory.hpp"

namespace fieldproof::cli {

struct JoinedRun {
  reports::PageRun run;
  reports::OutcomeRules rules;  // those that it ran under
};

// Where the run in a directory is a part, or may be one because the file that says so is gone, it is not
// complete: what was not judged in it is not green.
void say_that_it_is_a_part(const std::string& directory, reports::RunIdentity& identity);

// A run that is a whole as it is; parts in any order as the run that was never cut: equal octets of its
// results, and of every format but for times. Parts of another seed, suite, configuration or implementation,
// one part twice, and parts that are missing are a kernel::Error(configuration) that names the directory. A
// part that did not end makes a whole that did not end.
JoinedRun joined(const Session& session, const std::vector<std::string>& directories);

}  // namespace fieldproof::cli
