// Which of all the bits that a disturbance struck made a case or a test fail: the search of `shrink`.
//
// Contract: `still_fails` runs it with these bits in the place of all disturbances. It may also say no
// because time is over.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/flipped_bits.hpp"
#include "conformance/minimise.hpp"
#include "harness/trace/dissector.hpp"
#include "harness/trace/recording.hpp"

namespace fieldproof::cli {

// The fewest of the last 1, 2, 4 ... parts that do it: a run ends, or is cut, where it failed, so what
// mattered lies near the end. `last` gives at most so many. Nothing where not even all of them do it.
template <typename Part, typename Fails, typename Last>
std::optional<std::vector<Part>> fewest_of_the_last(Fails&& still_fails, Last&& last) {
  for (std::size_t most = 1;; most *= 2) {
    std::vector<Part> parts = last(most);
    const std::size_t count = parts.size();
    if (still_fails(parts)) return conformance::fewest(std::move(parts), still_fails);
    if (count < most) return std::nullopt;
  }
}

using StillFails = std::function<bool(const FlippedBits&)>;

// Nothing when bits alone do not make it fail.
std::optional<FlippedBits> bits_that_matter(const FlippedBits& struck, const StillFails& still_fails);
// One of the last bits alone, some transmissions earlier or later: without what came before it the same frame
// comes at another time.
std::optional<FlippedBits> moved_bit_that_matters(const FlippedBits& struck, const StillFails& still_fails);

// One line each.
std::string bit_lines(const FlippedBits& bits);
// What receivers got instead of what was sent, in the words of the protocol.
std::string change_lines(std::span<const trace::Change> changes, std::span<const std::string> channels,
                         const trace::Dissector& dissector);

}  // namespace fieldproof::cli
