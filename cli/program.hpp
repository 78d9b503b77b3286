// The program, given its suites: reads the command line, serves the verb, and turns every error into its
// sentence on standard error and its exit code, in one place.
#pragma once

#include <memory>
#include <vector>

#include "cli/disturbances.hpp"
#include "conformance/test_case.hpp"

namespace fieldproof::cli {

using Suites = std::vector<std::unique_ptr<conformance::Suite>>;

// The suites, their lines disturbed by nothing but these.
using MakeSuites = Suites (*)(const Disturbances&);

// `make_suites` is only called for a verb that needs them, after the command line was understood.
int run_program(int argc, const char* const* argv, MakeSuites make_suites);

}  // namespace fieldproof::cli
