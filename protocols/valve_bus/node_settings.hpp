#pragma once

#include "harness/field/settings.hpp"
#include "harness/iut/device.hpp"
#include "protocols/valve_bus/device.hpp"

// What a node is given at the beginning of a case.
namespace fieldproof::valve_bus {

extern const field::Table<NodeConfiguration> kNodeTable;

field::Settings node_settings(const NodeConfiguration& configuration);
// The other way round; what is not given is as the configuration has it anyway.
NodeConfiguration node_configuration_of(const iut::CaseBegin& begin);

}  // namespace fieldproof::valve_bus
