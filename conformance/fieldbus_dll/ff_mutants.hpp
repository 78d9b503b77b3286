#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "conformance/test_case.hpp"
#include "protocols/fieldbus_dll/ff_device.hpp"

// The stations of the profile FF-P that its suite must tell from the reference.
namespace fieldproof::conformance {

std::vector<Mutant> ff_mutants();

// Throws kernel::Error(usage) for a name that is none of this role, with the nearest ones.
std::unique_ptr<fieldbus_dll::FfDevice> make_ff_mutant(std::string_view role, std::string_view name,
                                                       const fieldbus_dll::FfConfiguration& configuration);

}  // namespace fieldproof::conformance
