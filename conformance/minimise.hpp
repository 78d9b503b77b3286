#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

// Makes what fails smaller: the minimiser of `check` and of `shrink`.
//
// `still_fails` is asked about a smaller candidate and says whether it fails in the way that is looked for;
// what is given is taken to fail. It may also say no because time is over: what is left then fails all the
// same. The result is smallest in the sense that no single step makes it smaller, not among all that fail.
namespace fieldproof::conformance {

// The fewest parts, in their order: delta debugging by Zeller and Hildebrandt, without its test of subsets,
// which a list of faults seldom needs. Asks for n parts of which k matter about k * log2(n) times.
template <typename Part, typename StillFails>
std::vector<Part> fewest(std::vector<Part> parts, StillFails&& still_fails) {
  if (!parts.empty() && still_fails(std::vector<Part>{})) return {};
  std::size_t piece = (parts.size() + 1) / 2;
  while (piece > 0) {
    bool is_smaller = false;
    for (std::size_t first = 0; first < parts.size();) {
      const std::size_t end = std::min(parts.size(), first + piece);
      std::vector<Part> rest(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(first));
      rest.insert(rest.end(), parts.begin() + static_cast<std::ptrdiff_t>(end), parts.end());
      if (!rest.empty() && still_fails(std::as_const(rest))) {
        parts = std::move(rest);
        is_smaller = true;
      } else {
        first = end;
      }
    }
    // Single parts are tried until none can go: one may have needed another that has gone since.
    if (piece > 1) {
      piece = (piece + 1) / 2;
    } else if (!is_smaller) {
      piece = 0;
    }
  }
  return parts;
}

// The number nearest to `simple` that a search by halves finds between it and `value`.
template <typename Number, typename StillFails>
Number simplest(Number value, Number simple, StillFails&& still_fails) {
  if (value == simple || still_fails(simple)) return simple;
  Number good = simple;  // does not fail
  while (true) {
    const Number middle = good + (value - good) / 2;
    if (middle == good || middle == value) return value;
    (still_fails(middle) ? value : good) = middle;
  }
}

}  // namespace fieldproof::conformance
