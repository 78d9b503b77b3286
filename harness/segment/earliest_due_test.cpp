#include "harness/segment/earliest_due.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

namespace fieldproof::segment {
namespace {

TEST(EarliestDue, OfNobodyIsNever) {
  const EarliestDue nobody;
  EXPECT_EQ(nobody.earliest(), kernel::kNever);
  EXPECT_EQ(nobody.first_due(0, kernel::kStart), 0U);
}

// Held against a plain list, while it grows and instants change.
RC_GTEST_PROP(EarliestDue, NamesWhoIsDueInOrder, ()) {
  EarliestDue tree;
  std::vector<kernel::Time> list;
  const auto steps = *rc::gen::container<std::vector<std::pair<unsigned, unsigned>>>(
      rc::gen::pair(rc::gen::inRange(0U, 40U), rc::gen::inRange(0U, 20U)));
  for (const auto& [n, at] : steps) {
    if (n >= list.size()) {
      tree.add();
      list.push_back(kernel::kNever);
      continue;
    }
    list[n] = at == 0 ? kernel::kNever : kernel::kStart + kernel::Duration{at};
    tree.set(n, list[n]);
    const kernel::Time now = kernel::kStart + kernel::Duration{at / 2};
    RC_ASSERT(tree.earliest() == *std::ranges::min_element(list));
    for (std::size_t from = 0; from <= list.size(); ++from) {
      const auto begin = list.begin() + static_cast<std::ptrdiff_t>(from);
      const auto due = std::find_if(begin, list.end(), [now](kernel::Time one) { return one <= now; });
      RC_ASSERT(tree.first_due(from, now) == static_cast<std::size_t>(due - list.begin()));
    }
  }
}

}  // namespace
}  // namespace fieldproof::segment
