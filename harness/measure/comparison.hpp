#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "harness/measure/phase.hpp"

// A measured quantity beside the one that a theory gives, and what the two say together.
namespace fieldproof::measure {

struct Comparison {
  std::string quantity;
  std::string unit;
  double theory = 0;
  double measured = 0;
  // What a deviation is told in parts of: for a time in a cyclic system usually the cycle time, so that a
  // small quantity is not held to a small error. Positive.
  double whole = 0;
  std::string whole_name;     // "of the cycle time"
  double standard_error = 0;  // of the measured value, by the number of samples; 0 where it is exact
  bool is_bound = false;      // the theory gives the most that may be, not the value
  Phase phase = Phase::quiet;

  double deviation_percent() const { return 100 * (measured - theory) / whole; }
};

enum class Agreement {
  holds,    // within the tolerance
  open,     // outside, but so few samples show it by chance
  differs,  // outside by more than three standard errors
};

std::string_view name(Agreement agreement);

// The tolerance is a part of `whole` in percent.
Agreement agreement(const Comparison& comparison, double tolerance_percent);
// The worst of all of a phase; nothing when there is none.
std::optional<Agreement> agreement(std::span<const Comparison> comparisons, double tolerance_percent,
                                   Phase phase);

}  // namespace fieldproof::measure
