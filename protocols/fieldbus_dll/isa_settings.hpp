#pragma once

#include "harness/field/settings.hpp"
#include "harness/iut/device.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"

// What a station of the profile ISA-D is given at the beginning of a case.
namespace fieldproof::fieldbus_dll {

extern const field::Table<IsaConfiguration> kIsaTable;

field::Settings isa_settings(const IsaConfiguration& configuration);
IsaConfiguration isa_configuration_of(const iut::CaseBegin& begin);

}  // namespace fieldproof::fieldbus_dll
