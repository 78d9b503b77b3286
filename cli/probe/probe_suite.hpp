#pragma once

#include <memory>

#include "conformance/test_case.hpp"

// A suite of invented cases, one for each way in which a run can end, so that tests see every exit code of
// the program. The protocol is called `probe`; its cases sleep, throw or answer as their ids say.
namespace fieldproof::cli {

std::unique_ptr<conformance::Suite> probe_suite();

}  // namespace fieldproof::cli
