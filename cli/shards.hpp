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

// A run that is a whole as it is; parts in any order as the run that was never cut: equal octets of its
// results, and of every format but for times. Parts of another seed, suite, configuration or implementation,
// one part twice, and parts that are missing are a kernel::Error(configuration) that names the directory. A
// part that did not end makes a whole that did not end.
// "1/4" of a run that is a part; empty of a whole one.
std::string shard_of(const std::string& directory);

JoinedRun joined(const Session& session, const std::vector<std::string>& directories);

}  // namespace fieldproof::cli
