#pragma once

#include "cli/program.hpp"

namespace fieldproof::cli {

// The protocols of the program, one row each in suites.cpp.
Suites suites(const Disturbances& disturbances);

}  // namespace fieldproof::cli
