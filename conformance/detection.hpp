// How soon the sequences of `check` find each mutant of a role, in commands.
//
// The n-th sequence of a seed runs on the reference and on every mutant that was not found yet. A mutant is
// triggered when its trace first differs from the reference's, and found when the comparison fails; what is
// triggered and never found is a hole of the comparison, what is never triggered one of the vocabulary.
//
// Contract: the same table for one first seed, whatever the number of jobs. kernel::Error of the suite passes
// through.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "conformance/suite.hpp"

namespace fieldproof::conformance {

// Of one mutant under one seed; numbers of commands, counted from the first sequence on.
struct Detection {
  std::optional<std::uint64_t> triggered{};
  std::optional<std::uint64_t> found{};
  std::uint64_t commands = 0;  // that it was given in all
  std::string reason{};        // of the finding
};

struct MutantDetections {
  const Mutant* mutant = nullptr;
  std::vector<Detection> by_seed{};
  // "CASE (REASON)", the first that declares to catch it; empty: no case does, `check` alone is to find it.
  std::string suite_catch{};
};

struct DetectionTable {
  std::string role;  // "PROTOCOL/ROLE"
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 0;
  std::uint64_t most_commands = 0;
  std::vector<MutantDetections> mutants{};
  std::vector<std::string> false_alarms{};  // reasons for which the reference itself was accused
  bool is_complete = true;

  std::uint64_t pairs() const { return mutants.size() * seeds; }
  std::uint64_t found() const;  // of these
};

struct DetectionPlan {
  const Suite* suite = nullptr;
  const SequenceRole* role = nullptr;
  Setup setup{};  // its seed is the first
  std::uint64_t seeds = 5;
  std::uint64_t most_commands = 1'000'000;  // of each mutant under each seed
  unsigned jobs = 1;
  std::stop_token stop{};
};

DetectionTable detect_mutants(const DetectionPlan& plan);

}  // namespace fieldproof::conformance
