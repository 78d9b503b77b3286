#pragma once

#include "conformance/mutant_table.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"

// The mutants of a basic device and of a link master of the profile FF-P.
namespace fieldproof::conformance {

using FfMutants = DeviceMutants<fieldbus_dll::FfDevice, fieldbus_dll::FfConfiguration>;
const FfMutants& ff_device_mutants();
const FfMutants& ff_las_mutants();

}  // namespace fieldproof::conformance
