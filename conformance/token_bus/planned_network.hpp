#pragma once

#include <memory>

#include "conformance/planned_network.hpp"

namespace fieldproof::conformance {

std::unique_ptr<PlannedNetwork> plan_token_bus(const NetworkRequest& request);

}  // namespace fieldproof::conformance
