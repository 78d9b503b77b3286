#pragma once

#include <string_view>
#include <vector>

#include "conformance/fieldbus_dll/ff_cases.hpp"

// What a basic device of the profile FF-P does a link master does in standby: the same cases for it, under
// ids of their own.
namespace fieldproof::conformance {

// In front of the name of a mutant of a device that plays a link master in standby.
inline constexpr std::string_view kStandbyMutant = "standby_";

// `all`: cases of both roles; those of a device are taken whose silences end before a link master would claim
// the link.
std::vector<FfCase> ff_standby_cases(const std::vector<FfCase>& all);

}  // namespace fieldproof::conformance
