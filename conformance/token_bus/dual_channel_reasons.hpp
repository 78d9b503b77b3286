#pragma once

#include <span>

#include "conformance/test_case.hpp"

// Which rule of protocols/token_bus/channel_manager.md a dual channel manager has broken, for each reason
// that a sequence of commands may end with.
namespace fieldproof::conformance {

std::span<const ReasonRule> dual_channel_reasons();

}  // namespace fieldproof::conformance
