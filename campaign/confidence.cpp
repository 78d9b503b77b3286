#include "campaign/confidence.hpp"

#include <algorithm>
#include <bit>

namespace fieldproof::campaign {

bool Confidence::add(const Outcome& outcome) {
  if (decision_ != Decision::open) return true;
  if (outcome.ledger.empty()) return false;
  total_ += count_of(outcome.ledger, goal_.is_of_differed ? "data_differed" : "sent");
  wrong_ += count_of(outcome.ledger, "wrong_cycles");
  ++jobs_;
  if (std::has_single_bit(jobs_)) look();
  return decision_ != Decision::open;
}

void Confidence::end() {
  if (decision_ == Decision::open && jobs_ > 0 && !std::has_single_bit(jobs_)) look();
}

void Confidence::look() {
  ++looks_;
  if (total_ == 0) return;
  const auto k = static_cast<double>(looks_);
  const double confidence = 1 - (1 - goal_.confidence) / (k * (k + 1));
  // Bounds take no more than there are.
  const std::uint64_t wrong = std::min(wrong_, total_);
  upper_ = bound_(wrong, total_, confidence);
  lower_ = wrong == 0 ? 0 : 1 - bound_(total_ - wrong, total_, confidence);
  if (upper_ < goal_.rate) decision_ = Decision::below;
  if (lower_ > goal_.rate) decision_ = Decision::above;
}

}  // namespace fieldproof::campaign
