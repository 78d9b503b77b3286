// The program, given its protocols: reads the command line, serves the verb, and turns every error into its
// sentence on standard error and its exit code, in one place.
#pragma once

#include <span>

#include "cli/protocol_entry.hpp"

namespace fieldproof::cli {

// The suites of the rows are only made after the command line was understood.
int run_program(int argc, const char* const* argv, std::span<const ProtocolEntry> protocols);

}  // namespace fieldproof::cli
