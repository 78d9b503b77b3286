// The results as CTRF, the Common Test Report Format (JSON), as dashboards and pull-request bots read it.
//
// Contract: a test per case with its outcome (outcome.hpp): an error is "failed", because a dashboard takes
// "other" lightly; `rawStatus` has the verdict. Complaints about the run are tests of the suite
// fieldproof.run. Valid against the schema of CTRF for any octets in any text.
#pragma once

#include <string>

#include "reports/outcome.hpp"
#include "reports/page_content.hpp"

namespace fieldproof::reports {

std::string ctrf_json(const PageRun& run, const OutcomeRules& rules);

}  // namespace fieldproof::reports
