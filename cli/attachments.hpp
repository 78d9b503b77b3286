#pragma once

#include <string_view>

#include "conformance/interbus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"

// Implementations outside the program, for the suites:
//
//   exec:./program ARGUMENTS     a process
//   unix:/path, tcp:HOST:PORT    who listens there
//   plugin:./library.so          a shared library, in a process of its own; with ?in-process in this one
namespace fieldproof::cli {

bool is_attachment(std::string_view uri);

// Implementations of one URI are kept from case to case, and as many are opened as cases run side by side.
conformance::GivenSlaves::Make attached_slaves();
conformance::GivenNodes::Make attached_nodes();
conformance::GivenHosts::Make attached_hosts();

}  // namespace fieldproof::cli
