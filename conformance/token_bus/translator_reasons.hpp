#pragma once

#include <span>

#include "conformance/test_case.hpp"

// Which rule of protocols/token_bus/translator.md a translator has broken, for each reason that a sequence of
// commands may end with.
namespace fieldproof::conformance {

std::span<const ReasonRule> translator_reasons();

}  // namespace fieldproof::conformance
