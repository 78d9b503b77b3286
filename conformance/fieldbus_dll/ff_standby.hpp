#pragma once

#include <string_view>
#include <vector>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/sequence.hpp"

// What a basic device of the profile FF-P does a link master does in standby: the same cases for it, under
// ids of their own.
namespace fieldproof::conformance {

// In front of the name of a mutant of a device that plays a link master in standby.
inline constexpr std::string_view kStandbyMutant = "standby_";

// `all`: cases of both roles; those of a device are taken whose silences end before a link master would claim
// the link.
std::vector<FfCase> ff_standby_cases(const std::vector<FfCase>& all);

// The sequences of a device, but for silences in which it would claim the link and what is an order of a link
// master.
const SequenceRole& ff_standby_sequence_role();
FfNeeds ff_standby_sequence_needs();

}  // namespace fieldproof::conformance
