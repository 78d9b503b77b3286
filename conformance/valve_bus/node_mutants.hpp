#pragma once

#include "conformance/mutant_table.hpp"
#include "protocols/valve_bus/device.hpp"

// The mutants of a local node of the valve bus.
namespace fieldproof::conformance {

using NodeMutants = DeviceMutants<valve_bus::NodeDevice, valve_bus::NodeConfiguration>;
const NodeMutants& node_mutants();

}  // namespace fieldproof::conformance
