#pragma once

#include "conformance/mutant_table.hpp"
#include "protocols/interbus/device.hpp"

// The mutants of a master.
namespace fieldproof::conformance {

using MasterMutants = DeviceMutants<interbus::MasterDevice, interbus::MasterConfiguration>;
const MasterMutants& master_mutants();

}  // namespace fieldproof::conformance
