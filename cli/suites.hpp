#pragma once

#include "cli/program.hpp"

// The protocols of the program, one row each in suites.cpp.
namespace fieldproof::cli {

Suites suites();

}  // namespace fieldproof::cli
