#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "conformance/bench_case.hpp"
#include "conformance/derived_cases.hpp"
#include "harness/kernel/check.hpp"

// Cases of families of sequences: each sequence on a bench of its own, as those that are derived. They have
// no settings: those of the case are the same for all.
namespace fieldproof::conformance {

struct FamiliesRun {
  const SequenceVocabulary& vocabulary;
  std::uint64_t seed = 1;
  Volume volume = Volume::full;
  std::optional<std::size_t> sequences{};  // of all families together; nothing: as many as the volume says
  std::size_t most_shrinking_commands = 0;
};

// `run_case` runs one that has a procedure.
template <typename Case, typename RunCase>
judge::CaseResult run_families(const Case& one, const FamiliesRun& given, const RunCase& run_case) {
  const kernel::Random random = kernel::Random(given.seed).split("families");
  DerivedRun all{.test_case = one.test_case,
                 .vocabulary = given.vocabulary,
                 .parts = {},
                 .most_shrinking_commands = given.most_shrinking_commands};
  for (const auto& family : *one.families) {
    std::size_t most = given.volume == Volume::quick ? family.quick : family.full;
    if (given.sequences)
      most = std::min(most, std::max<std::size_t>(*given.sequences / one.families->size(), 1));
    const auto run_one = [&one, &family, &run_case](const Sequence& sequence) {
      FIELDPROOF_CHECK(sequence.settings.empty(), "sequences of a family have no settings");
      Case asked = one;
      asked.procedure = [&](auto& bench, CaseJudge& judge) { family.run(sequence, bench, judge); };
      return run_case(asked);
    };
    all.parts.push_back({evenly_taken(family.all(random), most, random), run_one});
  }
  return run_derived_case(all);
}

}  // namespace fieldproof::conformance
