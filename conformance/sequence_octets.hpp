#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "conformance/sequence.hpp"

// Sequences as octets, for whoever searches by mutation of octets. Every input is a sequence, and a change of
// one octet changes one thing where it can.
//
// In front there may be an octet from F0h on: as many settings follow as its low half says and one, each an
// octet that chooses it and its number. Then there may be EFh and the place of a situation of the vocabulary,
// where there are any: it begins with those commands. A command is an octet that chooses the word, then its
// numbers, its octets (their count in front) and its faults (their count in front). A number is a selector:
// below 80h a likely value of the vocabulary, else what follows, between the limits. What is missing at the
// end is zero.
namespace fieldproof::conformance {

inline constexpr std::size_t kMostFuzzedCommands = 40;

// At most `kMostFuzzedCommands` commands; what is left of the input is not looked at.
Sequence sequence_of_octets(std::span<const std::uint8_t> octets, const SequenceVocabulary& vocabulary);
// Octets that are this sequence. What no input can say (more faults than are drawn) is left out.
std::vector<std::uint8_t> octets_of_sequence(const Sequence& sequence, const SequenceVocabulary& vocabulary);

}  // namespace fieldproof::conformance
