#pragma once

#include "protocols/token_bus/rules.hpp"

// Which numbers of a token bus can be judged.
namespace fieldproof::conformance {

// Throws kernel::Error(configuration) where half bits are no whole number of picoseconds: what begins at the
// very limit of a time, as cases let it, would be rounded to either side.
void expect_whole_half_bits(const token_bus::Rules& rules);
// The same, and for numbers that contradict each other.
void expect_possible(const token_bus::Rules& rules);

}  // namespace fieldproof::conformance
