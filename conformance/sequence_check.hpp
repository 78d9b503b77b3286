#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

#include "conformance/sequence.hpp"
#include "conformance/suite.hpp"
#include "conformance/test_case.hpp"

// The search of `check`: draws sequence after sequence, runs each on a bench of its own until one fails, and
// makes that one smaller as long as it fails for the same reason.
namespace fieldproof::conformance {

struct SequenceSearch {
  const Suite* suite = nullptr;
  const SequenceRole* role = nullptr;
  Setup setup;  // its seed decides everything
  std::uint64_t cases = 1'000;
  std::stop_token stop{};
  // Before a sequence is run, with the number of those that are done.
  std::function<void(std::uint64_t)> on_progress{};
};

struct SequenceFound {
  Sequence drawn;           // as it was drawn
  Sequence smallest;        // fails for the same reason
  Outcome outcome;          // of the smallest one, recorded
  judge::CaseResult first;  // of the drawn one, when it failed
  std::uint64_t shrinking_runs = 0;
  bool is_confirmed = true;  // the smallest one failed once more for that reason
};

struct SequenceSearchResult {
  std::uint64_t run = 0;             // sequences in front of what was found
  std::uint64_t passed = 0;          // of these: the reference agrees
  std::uint64_t silent = 0;          // of those that passed: the implementation drove nothing
  std::uint64_t not_applicable = 0;  // what they ask for cannot be done to this implementation
  std::uint64_t inconclusive = 0;
  std::optional<SequenceFound> found{};
};

// What `run_sequence` gives under this seed: the setup's seed is that of the run, a sequence has one of its
// own, as a case has.
Outcome run_sequence(const Suite& suite, const SequenceRole& role, const Sequence& sequence, Setup setup);

SequenceSearchResult search(const SequenceSearch& search);

// The same for a sequence that is known; nothing when it does not fail.
std::optional<SequenceFound> shrink(const Suite& suite, const SequenceRole& role, const Sequence& sequence,
                                    const Setup& setup, std::stop_token stop = {});

}  // namespace fieldproof::conformance
