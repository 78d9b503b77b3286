// What `replay` shows of what it ran: `--bits`, `--pcapng`, `--vcd`.
#pragma once

#include <string>

#include "cli/verbs.hpp"
#include "conformance/test_case.hpp"

namespace fieldproof::cli {

// Files that cannot be written are refused before anything is run.
void check_exports(const Settings& settings);
// `id` names what was run.
void show_recording(Session& session, const conformance::Recording& recording, const std::string& id);

}  // namespace fieldproof::cli
