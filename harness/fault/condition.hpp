#pragma once

#include <string_view>
#include <vector>

#include "harness/fault/arrivals.hpp"
#include "harness/fault/fields.hpp"
#include "harness/fault/rule.hpp"
#include "harness/kernel/random.hpp"

// A When as one receiver asks it: the name of the receiver is compared once, and what it waits for is found
// in the memory that all receivers share. Internal to the channel of a plan.
namespace fieldproof::fault {

// What all receivers share about one condition on observations.
struct AfterState {
  const After* after = nullptr;
  std::uint64_t seen = 0;
  kernel::Time since = kernel::kNever;  // of the nth observation

  bool is_over_at(kernel::Time at) const;
  bool holds(kernel::Time at) const { return at >= since && !is_over_at(at); }
};

// A part of a transmission that a rule may work on.
struct Candidate {
  const Span& span;
  Piece part;
  bool is_level;       // the part is one level of the span
  kernel::Time start;  // of the part
};

class Condition {
 public:
  // `next_after` runs through the states of the rule in the order of `each_after`.
  Condition(const When& when, std::string_view receiver, std::vector<AfterState>::const_iterator& next_after);

  // False when it never holds at this receiver.
  bool can_hold_here() const;
  // False when it does not hold for any part of a transmission in [start, end).
  bool can_hold_between(kernel::Time start, kernel::Time end) const;
  // False for all spans that are not of this kind; a first look before the part is worked out.
  bool may_mean(const Span& span) const;

  // All but the outermost chance and, if asked so, the outermost window.
  bool holds(const Candidate& candidate, bool with_window, kernel::Random& random) const;

  const When& when() const { return *when_; }

 private:
  bool holds_with_chance(const Candidate& candidate, kernel::Random& random) const;

  const When* when_;
  const AfterState* after_ = nullptr;
  bool is_here_;
  bool is_any_kind_;
  bool is_any_field_;
  std::vector<Condition> all_of_;
  std::vector<Condition> any_of_;
  std::vector<Condition> none_of_;
};

// Calls visit(after) for each condition on observations in the tree, always in the same order.
template <typename Visit>
void each_after(const When& when, const Visit& visit) {
  if (when.after) visit(*when.after);
  for (const When& inner : when.all_of) each_after(inner, visit);
  for (const When& inner : when.any_of) each_after(inner, visit);
  for (const When& inner : when.none_of) each_after(inner, visit);
}

}  // namespace fieldproof::fault
