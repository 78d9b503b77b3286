#pragma once

#include "conformance/sequence.hpp"
#include "conformance/sequence_draw.hpp"

// The smallest sequence that still fails: the fewest settings other than those of the bench, the fewest
// commands, then the fewest faults, then numbers and octets as simple as they can be; again from the front
// until nothing gets smaller.
namespace fieldproof::conformance {

// `sequence` fails. `still_fails` says no for good when there is no time left.
Sequence shrunk(Sequence sequence, const SequenceVocabulary& vocabulary, const SequenceFails& still_fails);

}  // namespace fieldproof::conformance
