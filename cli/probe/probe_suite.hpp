#pragma once

#include "cli/program.hpp"

// Suites of invented cases, one for each way in which a run can end, so that tests see every exit code of the
// program. `probe` is a good suite without a hole, `odd` has cases that fail, break, sleep or answer as their
// ids say, the implementations of `gone` cannot be reached.
namespace fieldproof::cli {

std::span<const ProtocolEntry> probe_protocols();

}  // namespace fieldproof::cli
