#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "conformance/test_case.hpp"
#include "protocols/valve_bus/device.hpp"

// The mutants of a host module of the valve bus by name: each is the reference with one decision or one
// number changed.
namespace fieldproof::conformance {

const std::vector<Mutant>& host_mutants();

// Throws kernel::Error(usage) for a name that is not there, with the nearest ones.
std::unique_ptr<valve_bus::HostDevice> make_host_mutant(std::string_view name,
                                                        const valve_bus::HostConfiguration& configuration);

}  // namespace fieldproof::conformance
