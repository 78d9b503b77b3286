#pragma once

#include <functional>
#include <memory>
#include <string>

#include "cli/verbs.hpp"
#include "protocols/valve_bus/device.hpp"

// `fieldproof station valve_bus/node ... --serial LINE`: a node in wall-clock time on a serial line, as a box
// would be. It stands in for one, and shows that a bench judges it there as it does inside.
namespace fieldproof::cli {

using MakeBuiltInNode =
    std::function<std::unique_ptr<valve_bus::NodeDevice>(const valve_bus::NodeConfiguration&)>;

// Until the bench closes the upper channel; at a socket, or without one, for ever. `built_in` makes the node
// of a URI that is no attachment.
void play_on_line(Session& session, const std::string& uri, const MakeBuiltInNode& built_in);

}  // namespace fieldproof::cli
