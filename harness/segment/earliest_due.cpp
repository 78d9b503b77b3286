#include "harness/segment/earliest_due.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::segment {

void EarliestDue::add() {
  if (++count_ <= leaves_) return;
  const std::vector<kernel::Time> before(tree_.begin() + static_cast<std::ptrdiff_t>(leaves_), tree_.end());
  leaves_ = std::max<std::size_t>(1, 2 * leaves_);
  tree_.assign(2 * leaves_, kernel::kNever);
  for (std::size_t n = 0; n < before.size(); ++n) set(n, before[n]);
}

void EarliestDue::set(std::size_t n, kernel::Time at) {
  FIELDPROOF_CHECK(n < count_, "an instant is that of one who has been added");
  std::size_t node = leaves_ + n;
  if (tree_[node] == at) return;
  tree_[node] = at;
  while ((node >>= 1) > 0) {
    const kernel::Time earlier = std::min(tree_[2 * node], tree_[2 * node + 1]);
    if (tree_[node] == earlier) return;
    tree_[node] = earlier;
  }
}

std::size_t EarliestDue::first_due(std::size_t from, kernel::Time now) const {
  if (from >= count_) return count_;
  std::size_t node = leaves_ + from;
  if (tree_[node] <= now) return from;
  // Up to the next subtree on the right that has one, then down to its leftmost.
  while (true) {
    while ((node & 1) != 0) node >>= 1;
    if (node == 0) return count_;
    if (tree_[node + 1] <= now) break;
    node >>= 1;
  }
  for (++node; node < leaves_;) node = tree_[2 * node] <= now ? 2 * node : 2 * node + 1;
  return node - leaves_;
}

}  // namespace fieldproof::segment
