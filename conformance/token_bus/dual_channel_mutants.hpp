#pragma once

#include "conformance/mutant_table.hpp"
#include "protocols/token_bus/dual_channel_device.hpp"

namespace fieldproof::conformance {

using ChannelManagerMutants =
    DeviceMutants<token_bus::ChannelManagerDevice, token_bus::ChannelManagerConfiguration>;

// Dual channel managers with one seeded fault each.
const ChannelManagerMutants& channel_manager_mutants();

}  // namespace fieldproof::conformance
