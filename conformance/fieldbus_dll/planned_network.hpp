#pragma once

#include "conformance/planned_network.hpp"

// The link that a file describes, or one of two link masters and four devices.
namespace fieldproof::conformance {

std::unique_ptr<PlannedNetwork> plan_link(const NetworkRequest& request);

}  // namespace fieldproof::conformance
