#pragma once

#include <cstddef>
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
// Sequences that a run of this volume takes.
std::size_t derived_count(DerivedKind kind, Volume volume);

// Without those of which the vocabulary gives no sequence.
std::vector<TestCase> derived_cases(const SequenceRole& role);
// Nothing: a case of its own.
std::optional<DerivedKind> derived_kind(const TestCase& test_case);

// What comes of the sequences of one case.
class DerivedResult {
 public:
  // All must outlive it.
  DerivedResult(const TestCase& test_case, const DerivedSequences& derived,
                const SequenceVocabulary& vocabulary);

  // False: it fails, and nothing needs to be run any more.
  bool add(const Sequence& sequence, judge::CaseResult one);
  judge::CaseResult take();

 private:
  void measure(std::string name, std::size_t count);

  const TestCase& test_case_;
  const DerivedSequences& derived_;
  const SequenceVocabulary& vocabulary_;
  judge::CaseResult worst_;
  std::size_t run_ = 0;
  std::size_t not_applicable_ = 0;
  std::string why_not_{};  // the first of them
};

}  // namespace fieldproof::conformance
