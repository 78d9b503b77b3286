#pragma once

#include "harness/field/settings.hpp"
#include "harness/iut/device.hpp"
#include "protocols/valve_bus/device.hpp"

// What a host module is given at the beginning of a case.
namespace fieldproof::valve_bus {

extern const field::Table<HostConfiguration> kHostTable;

field::Settings host_settings(const HostConfiguration& configuration);
HostConfiguration host_configuration_of(const iut::CaseBegin& begin);

}  // namespace fieldproof::valve_bus
