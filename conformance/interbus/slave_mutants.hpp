#pragma once

#include "conformance/mutant_table.hpp"
#include "protocols/interbus/device.hpp"

// The mutants of a slave; besides its decisions and numbers, also with one change at its receiver, its ports
// or its terminals.
namespace fieldproof::conformance {

using SlaveMutants = DeviceMutants<interbus::SlaveDevice, interbus::SlaveConfiguration>;
const SlaveMutants& slave_mutants();

}  // namespace fieldproof::conformance
