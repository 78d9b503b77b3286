#pragma once

#include <string>
#include <string_view>

#include "cli/verbs.hpp"

// `fieldproof station valve_bus/node ... --serial LINE`: a node in wall-clock time on a serial line, as a box
// would be. It stands in for one, and shows that a bench judges it there as it does inside.
namespace fieldproof::cli {

inline constexpr std::string_view kRoleOnLines = "valve_bus/node";

// Until the bench closes the upper channel; at a socket, or without one, for ever.
void play_on_line(Session& session, const std::string& uri);

}  // namespace fieldproof::cli
