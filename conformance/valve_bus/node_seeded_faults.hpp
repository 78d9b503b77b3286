#pragma once

#include <cstdint>
#include <span>

#include "protocols/valve_bus/node.hpp"

// Local nodes that differ from the reference in one decision each; node_mutants.cpp names and describes
// them. A decision that is a number is changed in the rules there, without a class. They lie by theme in
// node_command_seeded_faults.hpp, node_terminal_, node_answer_, node_framing_, node_loss_, node_meanwhile_
// and node_power_seeded_faults.hpp, and in node_sequence_seeded_faults.hpp; here is what all of these name.
namespace fieldproof::conformance::node_seeded_faults {

using kernel::Duration;
using kernel::Time;
using line::UartCharacter;
using valve_bus::CollectedFrame;
using valve_bus::Command;
using valve_bus::Node;
using valve_bus::Response;
using Octets = std::span<const std::uint8_t>;

}  // namespace fieldproof::conformance::node_seeded_faults
