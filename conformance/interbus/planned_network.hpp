#pragma once

#include "conformance/planned_network.hpp"
#include "protocols/interbus/network.hpp"

// The ring that a file describes, or that of the cycle-time paper.
namespace fieldproof::conformance {

interbus::NetworkDescription planned_interbus_network(const std::string& file);

std::unique_ptr<PlannedNetwork> plan_interbus(const NetworkRequest& request);

}  // namespace fieldproof::conformance
