// Ends a campaign when enough is known: the share of exchanges in which a wrong word was accepted is below a
// limit, or above it, each shown with a confidence.
//
// Contract: jobs are added in the order of their ids, so the decision does not depend on which was faster.
// Who looks again and again until chance helps finds what is not there. So it is looked after 1, 2, 4, 8 ...
// jobs that have a ledger, and once more at the end; look k may err with (1 - confidence) / (k (k + 1)),
// which is 1 - confidence for all looks together. The bounds are exact for exchanges that fail independently
// of each other; within one burst they do not.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "campaign/outcome.hpp"

namespace fieldproof::campaign {

// The exact one-sided upper bound of the share that gave `wrong` of `total`.
using UpperBound = std::function<double(std::uint64_t wrong, std::uint64_t total, double confidence)>;

struct ConfidenceGoal {
  double rate = 0;  // 0 < rate < 1
  double confidence = 0.95;
  bool is_of_differed = false;  // else of all exchanges that were sent
};

enum class Decision : std::uint8_t { open, below, above };

class Confidence {
 public:
  Confidence(const ConfidenceGoal& goal, UpperBound bound) : goal_(goal), bound_(std::move(bound)) {}

  // True when it is decided.
  bool add(const Outcome& outcome);
  // The last look, where there are no more jobs.
  void end();

  const ConfidenceGoal& goal() const { return goal_; }
  Decision decision() const { return decision_; }
  std::uint64_t wrong() const { return wrong_; }
  std::uint64_t total() const { return total_; }
  std::uint64_t looks() const { return looks_; }
  // At the last look, with its confidence; 0 and 1 before the first.
  double lower() const { return lower_; }
  double upper() const { return upper_; }

 private:
  void look();

  ConfidenceGoal goal_;
  UpperBound bound_;
  std::uint64_t wrong_ = 0;
  std::uint64_t total_ = 0;
  std::uint64_t jobs_ = 0;
  std::uint64_t looks_ = 0;
  double lower_ = 0;
  double upper_ = 1;
  Decision decision_ = Decision::open;
};

}  // namespace fieldproof::campaign
