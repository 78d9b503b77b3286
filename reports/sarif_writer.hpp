// The results as SARIF 2.1.0, as code-scanning services and editors read it.
//
// Contract: a rule is what a case requires, with the id of the case; its properties say source, standing and
// whether the source is verified. A result is a case that warns, fails, is inconclusive, an error or not
// judged; those that pass or do not apply are rules without a result, because services show every result as
// an alert. fail and error are "fail" with level "error", warn with level "warning", inconclusive and none
// "open". What the baseline expects is suppressed with its reason. The thread flow of a result is what
// happened in virtual time: the steps of the case, what was done to the line, the last transmissions before
// the first finding, and the findings. An incomplete run and a baseline that is not current are
// notifications, and the invocation was not successful. Valid against the schema of SARIF for any octets in
// any text; no text of an implementation makes a link.
#pragma once

#include <string>

#include "reports/page_content.hpp"

namespace fieldproof::reports {

std::string sarif_json(const PageRun& run);

}  // namespace fieldproof::reports
