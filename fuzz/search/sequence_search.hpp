#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

#include "conformance/sequence_check.hpp"

// The search of `fieldproof fuzz`: sequences are mutated as octets, and those that take the implementation
// where none has been before are kept and mutated further. The bench and the comparison are those of `check`.
// Without coverage of the implementation nothing is kept, and sequences are drawn as `check` draws them.
namespace fieldproof::fuzz {

struct SequenceFuzz {
  const conformance::Suite* suite = nullptr;
  const conformance::SequenceRole* role = nullptr;
  conformance::Setup setup;  // its seed decides what is tried
  std::uint64_t runs = 1'000;
  std::stop_token stop{};
  std::function<void(std::uint64_t)> on_progress{};  // before each run
};

struct SequenceFuzzResult {
  std::uint64_t run = 0;  // without a finding
  std::uint64_t passed = 0;
  std::uint64_t silent = 0;  // of those that passed: the implementation drove nothing
  std::uint64_t inconclusive = 0;
  std::size_t kept = 0;   // inputs that passed new edges
  std::size_t edges = 0;  // passed by all of them, by class of count
  bool has_coverage = false;
  std::optional<conformance::SequenceFound> found{};
};

SequenceFuzzResult search(const SequenceFuzz& fuzz);

}  // namespace fieldproof::fuzz
