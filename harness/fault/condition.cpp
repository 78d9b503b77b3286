#include "harness/fault/condition.hpp"

#include <algorithm>

namespace fieldproof::fault {
namespace {

std::vector<Condition> conditions(const std::vector<When>& whens, std::string_view receiver,
                                  std::vector<AfterState>::const_iterator& next_after) {
  std::vector<Condition> result;
  result.reserve(whens.size());
  for (const When& when : whens) result.emplace_back(when, receiver, next_after);
  return result;
}

}  // namespace

bool AfterState::is_over_at(kernel::Time at) const {
  return since != kernel::kNever && after->lasting != kernel::Duration::max() && at - since >= after->lasting;
}

// The members that look for observations come in the order of each_after, which is the order of declaration.
Condition::Condition(const When& when, std::string_view receiver,
                     std::vector<AfterState>::const_iterator& next_after)
    : when_(&when),
      after_(when.after ? &*next_after++ : nullptr),
      is_here_(fits(when.receiver, receiver)),
      is_any_kind_(when.frame_kind == "*"),
      is_any_field_(when.field == "*"),
      all_of_(conditions(when.all_of, receiver, next_after)),
      any_of_(conditions(when.any_of, receiver, next_after)),
      none_of_(conditions(when.none_of, receiver, next_after)) {}

bool Condition::can_hold_here() const {
  const auto can = [](const Condition& inner) { return inner.can_hold_here(); };
  return is_here_ && std::all_of(all_of_.begin(), all_of_.end(), can) &&
         (any_of_.empty() || std::any_of(any_of_.begin(), any_of_.end(), can));
}

bool Condition::can_hold_between(kernel::Time start, kernel::Time end) const {
  if (end <= when_->from || start >= when_->to) return false;
  return after_ == nullptr || (after_->since < end && !after_->is_over_at(start));
}

bool Condition::may_mean(const Span& span) const {
  return when_->frame.contains(span.frame) && when_->unit.contains(span.unit) &&
         when_->bit.first < span.count && (is_any_kind_ || fits(when_->frame_kind, span.frame_kind)) &&
         (is_any_field_ || fits(when_->field, span.field));
}

bool Condition::holds(const Candidate& candidate, bool with_window, kernel::Random& random) const {
  if (!is_here_ || !may_mean(candidate.span)) return false;
  if (candidate.is_level && !when_->bit.contains(candidate.part.first - candidate.span.first)) return false;
  if (with_window && (candidate.start < when_->from || candidate.start >= when_->to)) return false;
  if (after_ != nullptr && !after_->holds(candidate.start)) return false;
  const auto is_met = [&](const Condition& inner) { return inner.holds_with_chance(candidate, random); };
  return std::all_of(all_of_.begin(), all_of_.end(), is_met) &&
         (any_of_.empty() || std::any_of(any_of_.begin(), any_of_.end(), is_met)) &&
         std::none_of(none_of_.begin(), none_of_.end(), is_met);
}

bool Condition::holds_with_chance(const Candidate& candidate, kernel::Random& random) const {
  return holds(candidate, true, random) && (when_->chance >= 1.0 || random.chance(when_->chance));
}

}  // namespace fieldproof::fault
