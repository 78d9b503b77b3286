#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "conformance/test_case.hpp"
#include "protocols/interbus/device.hpp"

// Slaves that misbehave: each is the reference with one decision overridden, one number of its rules changed,
// or one change at its receiver, its ports or its terminals. The suite's cases say which of them they catch.
namespace fieldproof::conformance {

const std::vector<Mutant>& slave_mutants();

// A mutant slave; throws kernel::Error(usage) with the nearest names for an unknown one.
std::unique_ptr<interbus::SlaveDevice> make_slave_mutant(std::string_view name,
                                                         const interbus::SlaveConfiguration& configuration);

}  // namespace fieldproof::conformance
