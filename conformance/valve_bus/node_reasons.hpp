#pragma once

#include <span>

#include "conformance/test_case.hpp"

// Which rule of the page is broken, for each reason for which a sequence for a local node of the valve bus
// fails.
namespace fieldproof::conformance {

std::span<const ReasonRule> node_reasons();

}  // namespace fieldproof::conformance
