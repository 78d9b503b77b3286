#pragma once

#include <memory>
#include <vector>

#include "conformance/test_case.hpp"

// Suites of invented cases, one for each way in which a run can end, so that tests see every exit code of the
// program. `probe` is a good suite without a hole, `odd` has cases that fail, break, sleep or answer as their
// ids say, the implementations of `gone` cannot be reached.
namespace fieldproof::cli {

std::vector<std::unique_ptr<conformance::Suite>> probe_suites();

}  // namespace fieldproof::cli
