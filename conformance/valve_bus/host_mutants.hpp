#pragma once

#include "conformance/mutant_table.hpp"
#include "protocols/valve_bus/device.hpp"

// The mutants of a host module of the valve bus.
namespace fieldproof::conformance {

using HostMutants = DeviceMutants<valve_bus::HostDevice, valve_bus::HostConfiguration>;
const HostMutants& host_mutants();

}  // namespace fieldproof::conformance
