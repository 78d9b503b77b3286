#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "conformance/test_case.hpp"
#include "protocols/valve_bus/device.hpp"

// The mutants of a local node of the valve bus by name: each is the reference with one decision or one
// number changed.
namespace fieldproof::conformance {

const std::vector<Mutant>& node_mutants();

// Throws kernel::Error(usage) for a name that is not there, with the nearest ones.
std::unique_ptr<valve_bus::NodeDevice> make_node_mutant(std::string_view name,
                                                        const valve_bus::NodeConfiguration& configuration);

}  // namespace fieldproof::conformance
