// The states of a machine that single commands tell apart, and the walks that show whether another machine
// has the same ones.
//
// The method is Wp: a transition cover, and after each transition what tells the state that it leads to from
// all others. It holds for machines that are asked nothing but these commands and answer to each at once:
// where `is_whole`, a machine with at most `states`, and the `more` of its bounds, that answers to all walks
// as this one is the machine of these states. Whether this one is that machine itself `first_surprise` looks
// at, and not further than it says: nobody can ask a machine everything. Time is no part of an answer: two
// states that differ in when they do the same are one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "conformance/sequence.hpp"

namespace fieldproof::conformance {

using WalkWord = std::vector<std::size_t>;  // commands of the alphabet, by their numbers

struct Walks {
  std::size_t states = 0;
  bool is_whole = true;         // false: there are more states than were looked for
  std::vector<WalkWord> words;  // each once, none the beginning of another
};

// What the machine does upon the last command of a word, as a number: equal numbers are equal answers.
using WalkAnswer = std::function<std::uint64_t(const WalkWord&)>;

struct WalkBounds {
  std::size_t most_states = 0;
  std::size_t more = 0;  // that another machine may have
};

Walks explore(std::size_t commands, const WalkAnswer& answer, const WalkBounds& bounds);

// A word of two commands beyond a state, and a third, to which the machine does not answer as the states that
// were found do: single commands do not tell all of its states apart. Asks for as many answers as states
// times commands to the third.
std::optional<WalkWord> first_surprise(std::size_t commands, const WalkAnswer& answer,
                                       const WalkBounds& bounds);

// One command of each word, as those that bring a station into its states have it, else a usual one; then
// what else brings it into states. At most `most`.
std::vector<SequenceCommand> walk_alphabet(const SequenceVocabulary& vocabulary, std::size_t most);

}  // namespace fieldproof::conformance
