#pragma once

#include <span>

#include "conformance/test_case.hpp"

// Which rule of the page is broken, for each reason for which a sequence for a link master of the profile
// ISA-D fails.
namespace fieldproof::conformance {

std::span<const ReasonRule> isa_las_reasons();

}  // namespace fieldproof::conformance
