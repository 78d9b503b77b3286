#pragma once

#include "protocols/interbus/slave.hpp"

// Slaves that differ from the reference in one decision each; the table of their names is in
// slave_mutants.cpp. They lie by theme in slave_frame_seeded_faults.hpp, slave_register_, slave_driving_ and
// slave_supervision_seeded_faults.hpp; here is what all of these name.
namespace fieldproof::conformance::slave_seeded_faults {

using interbus::Slave;
using interbus::SlaveConfiguration;
using interbus::SlavePorts;
using interbus::Terminals;

}  // namespace fieldproof::conformance::slave_seeded_faults
