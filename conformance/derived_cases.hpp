#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "conformance/derived_sequences.hpp"
#include "conformance/test_case.hpp"

// The cases of a role that are made of its vocabulary: "PROTOCOL/ROLE/derived/...", one for each kind of
// derived sequences. Each sequence runs on a bench of its own and is compared with the references as `check`
// does it; the first that fails is the verdict of its case.
namespace fieldproof::conformance {

inline constexpr std::size_t kDerivedOnRealLine = 10;  // sequences of a case: each lasts as long as it lasts
// Sequences that a run of this volume takes of a role whose sequences cost so much (SequenceRole::cost).
std::size_t derived_count(DerivedKind kind, Volume volume, std::size_t cost);

// "PROTOCOL/ROLE/derived/each_unit_spoilt" of "PROTOCOL/ROLE/check/...", whatever stands in front of "check".
std::string derived_id(const SequenceRole& role, DerivedKind kind);
// Without those of which the vocabulary gives no sequence.
std::vector<TestCase> derived_cases(const SequenceRole& role);
// Nothing: a case of its own.
std::optional<DerivedKind> derived_kind(const TestCase& test_case);

// How many sequences of a kind are about one thing, and how many of them a run takes; where that is less, it
// takes others with each seed. Walks are counted when their reference is asked, and what is drawn has no end.
struct DerivedExtent {
  DerivedKind kind;
  std::string id;  // of its case
  std::size_t there_are = 0;
  std::size_t quick = 0;
  std::size_t full = 0;
};
std::vector<DerivedExtent> derived_extents(const SequenceRole& role);

// Commands that are run to find the smallest sequence that fails as the first one does, and as many to find
// what decides that.
inline constexpr std::size_t kShrinkingCommands = 2'000;

// Sequences of a case, and how each is run on a bench of its own.
struct DerivedPart {
  DerivedSequences derived;
  std::function<judge::CaseResult(const Sequence&)> run;
};

// One run of a case; what it refers to must outlive it.
struct DerivedRun {
  const TestCase& test_case;
  const SequenceVocabulary& vocabulary;
  std::vector<DerivedPart> parts;  // at least one
  std::size_t most_shrinking_commands = kShrinkingCommands;
};

// Runs the sequences up to the first that fails, and makes that one smaller: what is reported is the
// smallest that was found, with what decides that it fails, and it is the last that is run. Where no sequence
// can be done the case does not apply; where the implementation drives nothing in any it is inconclusive.
judge::CaseResult run_derived_case(const DerivedRun& given);

}  // namespace fieldproof::conformance
