#pragma once

#include <span>

#include "conformance/test_case.hpp"

// Which rule of the page is broken, for each reason for which a sequence for an INTERBUS slave fails.
namespace fieldproof::conformance {

std::span<const ReasonRule> slave_reasons();

}  // namespace fieldproof::conformance
