#include "harness/field/boundaries.hpp"

#include <algorithm>
#include <limits>

namespace fieldproof::field {

Boundaries boundaries_of(const Row& row, const void* object) {
  using Limits = std::numeric_limits<std::int64_t>;
  Boundaries boundaries;
  if (row.kind == Kind::choice) {
    for (const Choice& choice : row.about.choices) boundaries.inside.push_back(choice.value);
    std::ranges::sort(boundaries.inside);
    return boundaries;
  }
  const auto [least, most] = row.about.range;
  std::vector<std::int64_t>& inside = boundaries.inside;
  inside = {0, least, most, row.get(object)};
  if (least < Limits::max()) inside.push_back(least + 1);
  if (most > Limits::min()) inside.push_back(most - 1);
  std::ranges::sort(inside);
  inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
  std::erase_if(inside, [&](std::int64_t value) { return value < least || value > most; });
  if (row.kind == Kind::truth) return boundaries;
  if (least > Limits::min()) boundaries.outside.push_back(least - 1);
  if (most < Limits::max()) boundaries.outside.push_back(most + 1);
  return boundaries;
}

}  // namespace fieldproof::field
