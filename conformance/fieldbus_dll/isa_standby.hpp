#pragma once

#include <vector>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/standby.hpp"

// A link master of the profile ISA-D in standby: what a basic station does, but for what is an order of a
// link master.
namespace fieldproof::conformance {

std::vector<IsaCase> isa_standby_cases(const std::vector<IsaCase>& all);
const SequenceRole& isa_standby_sequence_role();
IsaNeeds isa_standby_sequence_needs();

}  // namespace fieldproof::conformance
