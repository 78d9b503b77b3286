#pragma once

#include <cstdint>
#include <span>

#include "protocols/valve_bus/host.hpp"

// Host modules that differ from the reference in one decision each; host_mutants.cpp names and describes
// them. A decision that is a number is changed in the rules there, without a class. They lie by theme in
// host_application_seeded_faults.hpp, host_request_ and host_response_seeded_faults.hpp; here is what all of
// these name.
namespace fieldproof::conformance::host_seeded_faults {

using kernel::Duration;
using kernel::Time;
using line::UartCharacter;
using valve_bus::CollectedFrame;
using valve_bus::Command;
using valve_bus::CommandFifo;
using valve_bus::Host;
using valve_bus::HostConfiguration;
using valve_bus::HostCounters;
using valve_bus::HostError;
using valve_bus::HostErrorKind;
using valve_bus::HostResponse;
using valve_bus::Response;
using Octets = std::span<const std::uint8_t>;

}  // namespace fieldproof::conformance::host_seeded_faults
