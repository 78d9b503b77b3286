#pragma once

#include <span>

#include "cli/protocol_entry.hpp"

namespace fieldproof::cli {

// The protocols of this project, one row each: the only place outside of their folders that names them.
std::span<const ProtocolEntry> built_in_protocols();
// Under all disturbances; for tests.
Suites built_in_suites();

}  // namespace fieldproof::cli
