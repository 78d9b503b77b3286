// The walks through the states of a role's reference, by the commands of its vocabulary.
#pragma once

#include "conformance/derived_sequences.hpp"
#include "conformance/suite.hpp"

namespace fieldproof::conformance {

// Of the usual reference, whatever a setup has besides; they are found once in a program, when the first
// asks. A command is answered by all that the reference does from the first stimulus on that comes with it.
DerivedSequences walk_sequences(const Suite& suite, const SequenceRole& role, Volume volume, std::size_t most,
                                kernel::Random random);

}  // namespace fieldproof::conformance
