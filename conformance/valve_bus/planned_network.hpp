#pragma once

#include "conformance/planned_network.hpp"

// The line that a file describes, or one of 8 nodes on 1000 m.
namespace fieldproof::conformance {

std::unique_ptr<PlannedNetwork> plan_valve_bus(const NetworkRequest& request);

}  // namespace fieldproof::conformance
