#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/sequence.hpp"
#include "harness/kernel/random.hpp"

// Sequences that are derived from the vocabulary of a role instead of being listed: each number of each word
// at its boundaries, each unit of each transmission spoilt, each setting at its ends, each three words in
// each order, the same many times; and, at last, any sequences as `check` draws them. A new word, number or
// setting gets all of it by its row.
//
// Whatever a sequence is about stands between others: in front of it what brings the station into a state,
// and a word that leaves something behind; after it one of each word, in their order or the other, which
// shows what it has left behind.
namespace fieldproof::conformance {

enum class DerivedKind : std::uint8_t { values, faults, words, states, walks, repetitions, settings, drawn };

struct DerivedRow {
  DerivedKind kind;
  std::string_view name;  // of its case, after "PROTOCOL/ROLE/derived/"
  std::string_view stimulus;
  std::size_t quick = 400;  // sequences of it at this volume
  std::size_t full = 5'000;
};
extern const std::array<DerivedRow, 8> kDerivedRows;

// What may be chosen for a number of a command: both ends, their neighbours, powers of two and their
// neighbours, and what the vocabulary names; each once, what is simple first.
std::vector<std::int64_t> derived_values(const SequenceNumber& number);

// One of each command, as simple as it can be.
Sequence one_of_each(const SequenceVocabulary& vocabulary);

// Whether there is any sequence of this kind.
bool has_derived(DerivedKind kind, const SequenceVocabulary& vocabulary);

struct DerivedSequences {
  std::vector<Sequence> sequences;
  std::size_t singles = 0;  // one thing at a time: how many there are (of what is drawn: 0),
  std::size_t taken = 0;    // and how many of them are here
  // What else there is to count, for the report.
  std::vector<std::pair<std::string, std::size_t>> counts{};
};

// How often a command comes at most. At full volume each usual transmission comes a thousand times once;
// others, waits and two in turn do not, for the time that takes.
inline constexpr std::size_t kManyRepetitions = 300;
inline constexpr std::size_t kMostRepetitions = 1'000;

// All that is made about one thing; where that is more than `most`, so many of them, drawn.
DerivedSequences taken_of(std::vector<std::function<Sequence()>> makers, std::size_t most,
                          kernel::Random random);

// So many of them, at equal distances from one that is drawn.
DerivedSequences evenly_taken(const std::vector<Sequence>& all, std::size_t most, kernel::Random random);

// All sequences about one thing when `most` is enough for them, else as many of them, drawn; what is left of
// `most`, of settings of two fifths of it, is about two things: each two values of two numbers of a word
// together, then what is drawn. The same stream gives the same sequences.
DerivedSequences derived_sequences(DerivedKind kind, const SequenceVocabulary& vocabulary, std::size_t most,
                                   kernel::Random random, std::size_t repetitions = kManyRepetitions);

}  // namespace fieldproof::conformance
