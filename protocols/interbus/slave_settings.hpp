#pragma once

#include "harness/field/settings.hpp"
#include "harness/iut/device.hpp"
#include "protocols/interbus/device.hpp"

// What a slave is given at the beginning of a case.
namespace fieldproof::interbus {

extern const field::Table<SlaveConfiguration> kSlaveTable;

// A slave on a local bus is given the delays of such a one.
field::Settings slave_settings(const SlaveConfiguration& configuration);
// The other way round, up to the name. Throws kernel::Error for a frame check that no catalogue has.
SlaveConfiguration slave_configuration_of(const iut::CaseBegin& begin);

}  // namespace fieldproof::interbus
