// The walks through the states of a role's reference, by the commands of its vocabulary.
#pragma once

#include "conformance/derived_sequences.hpp"
#include "conformance/suite.hpp"

namespace fieldproof::conformance {

// Of the usual reference, whatever a setup has besides; they are found once in a program, when the first
// asks. A command is answered by all that the reference does from the first stimulus on that comes with it.
DerivedSequences walk_sequences(const Suite& suite, const SequenceRole& role, Volume volume, std::size_t most,
                                kernel::Random random);

// A command after two others to which the reference does not answer as the states that were found do, in the
// words of the role; empty: there is none. For tests: it asks the reference some hundred thousand times.
std::vector<std::string> surprise_of(const Suite& suite, const SequenceRole& role);

}  // namespace fieldproof::conformance
