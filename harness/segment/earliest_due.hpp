#pragma once

#include <cstddef>
#include <vector>

#include "harness/kernel/time.hpp"

// When each of several is due next, and who is due by now: a tree whose inner nodes have the earlier instant
// of their two children, so that a change walks one path and nobody who is not due is looked at.
namespace fieldproof::segment {

class EarliestDue {
 public:
  // One more, due never.
  void add();
  void set(std::size_t n, kernel::Time at);
  // Of all; kNever where none is due.
  kernel::Time earliest() const { return tree_.empty() ? kernel::kNever : tree_[1]; }
  // The first one from `from` on that is due by `now`; the count of all where there is none.
  std::size_t first_due(std::size_t from, kernel::Time now) const;

 private:
  std::size_t count_ = 0;
  std::size_t leaves_ = 0;            // a power of two
  std::vector<kernel::Time> tree_{};  // the root is 1, the children of n are 2 n and 2 n + 1
};

}  // namespace fieldproof::segment
