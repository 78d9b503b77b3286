#pragma once

#include "conformance/valve_bus/suite.hpp"

// Implementations outside the program, for the suites: what `exec:`, `unix:` and `tcp:` mean.
namespace fieldproof::cli {

// Implementations of one URI are kept from case to case, and as many are opened as cases run side by side.
conformance::ValveBusGiven::MakeNode attached_nodes();

}  // namespace fieldproof::cli
