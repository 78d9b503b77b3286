#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "conformance/test_case.hpp"
#include "protocols/fieldbus_dll/isa_device.hpp"

// The stations of the profile ISA-D that its suite must tell from the reference.
namespace fieldproof::conformance {

std::vector<Mutant> isa_mutants();

// Throws kernel::Error(usage) for a name that is none of this role, with the nearest ones.
std::unique_ptr<fieldbus_dll::IsaDevice> make_isa_mutant(std::string_view role, std::string_view name,
                                                         const fieldbus_dll::IsaConfiguration& configuration);

}  // namespace fieldproof::conformance
