#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "conformance/sequence_check.hpp"

// The search of `fieldproof fuzz`: sequences are mutated as octets, and those that take the implementation
// where none has been before are kept and mutated further. The bench and the comparison are those of `check`.
// It may begin with sequences of an earlier search: they are run first, and what it tries depends on them.
// Without coverage of the implementation nothing is kept, and sequences are drawn as `check` draws them.
namespace fieldproof::fuzz {

struct SequenceFuzzResult;

struct SequenceFuzz {
  const conformance::Suite* suite = nullptr;
  const conformance::SequenceRole* role = nullptr;
  conformance::Setup setup;                    // its seed decides what is tried
  std::vector<conformance::Sequence> seeds{};  // run before, and not counted in `runs`
  std::uint64_t runs = 1'000;
  std::stop_token stop{};
  // Before each run: what those before it showed, and its octets. Of each input that is kept. Of a finding,
  // before it is made smaller.
  std::function<void(const SequenceFuzzResult&, std::span<const std::uint8_t>)> on_begin{};
  std::function<void(std::span<const std::uint8_t>)> on_kept{};
  std::function<void()> on_found{};
};

// How far a search had come.
struct GrowthPoint {
  std::uint64_t run = 0;  // sequences, with the seeds
  std::size_t edges = 0;
  std::size_t kept = 0;
  friend bool operator==(const GrowthPoint&, const GrowthPoint&) = default;
};

struct SequenceFuzzResult {
  std::uint64_t run = 0;      // without a finding, besides the seeds
  std::size_t seeds_run = 0;  // without a finding
  bool is_found_in_seed = false;
  std::uint64_t passed = 0;
  std::uint64_t silent = 0;  // of those that passed: the implementation drove nothing
  std::uint64_t inconclusive = 0;
  std::size_t kept = 0;   // inputs that passed new edges
  std::size_t edges = 0;  // passed by all of them
  // After 1, 2, 5, 10, 20, 50 ... sequences, after the seeds, and at the end.
  std::vector<GrowthPoint> growth{};
  // Sequences that are enough to pass what all have passed, each as often by class; then the seeds that were
  // not run any more. Without coverage: the seeds.
  std::vector<conformance::Sequence> corpus{};
  bool has_coverage = false;
  std::optional<conformance::SequenceFound> found{};
};

SequenceFuzzResult search(const SequenceFuzz& fuzz);

}  // namespace fieldproof::fuzz
