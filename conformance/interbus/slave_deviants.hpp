#pragma once

#include "protocols/interbus/slave.hpp"

// Slaves that differ from the reference in one decision each; the table of their names is in
// slave_deviations.cpp. They lie by theme in slave_frame_deviants.hpp, slave_register_, slave_driving_ and
// slave_supervision_deviants.hpp; here is what all of these name.
namespace fieldproof::conformance::slave_deviants {

using interbus::Slave;
using interbus::SlaveConfiguration;
using interbus::SlavePorts;
using interbus::Terminals;

}  // namespace fieldproof::conformance::slave_deviants
