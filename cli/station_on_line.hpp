#pragma once

#include <string>

#include "cli/protocol_entry.hpp"
#include "cli/verbs.hpp"

// `fieldproof station ROLE ... --serial LINE`: a station in wall-clock time on a serial line, as a box
// would be. It stands in for one, and shows that a bench judges it there as it does inside.
namespace fieldproof::cli {

// Until the bench closes the upper channel; at a socket, or without one, for ever.
void play_on_line(Session& session, const Role& role, const std::string& uri);

}  // namespace fieldproof::cli
