#pragma once

#include "conformance/mutant_table.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"

// The mutants of a data link entity and of a link master of the profile ISA-D.
namespace fieldproof::conformance {

using IsaMutants = DeviceMutants<fieldbus_dll::IsaDevice, fieldbus_dll::IsaConfiguration>;
const IsaMutants& isa_dle_mutants();
const IsaMutants& isa_las_mutants();

}  // namespace fieldproof::conformance
