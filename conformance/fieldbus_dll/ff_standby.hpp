#pragma once

#include <vector>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/standby.hpp"

// A link master of the profile FF-P in standby: what a basic device does, but for silences in which it would
// claim the link and what is an order of a link master.
namespace fieldproof::conformance {

std::vector<FfCase> ff_standby_cases(const std::vector<FfCase>& all);
const SequenceRole& ff_standby_sequence_role();
FfNeeds ff_standby_sequence_needs();

}  // namespace fieldproof::conformance
