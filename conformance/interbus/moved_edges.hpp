#pragma once

#include <cstddef>
#include <cstdint>

#include "conformance/interbus/slave_bench.hpp"

// Edges that do not lie in the grid of their telegram: how they are put on a line, and how far off those are
// that a slave drives.
namespace fieldproof::conformance {

inline constexpr std::int64_t kEdgesPerBit = 20;

// Writes levels at twenty per bit, each edge moved by `shift(is_falling)` twentieths; no edge overtakes one.
template <typename Shift>
line::Levels with_moved_edges(const line::Levels& levels, Shift&& shift) {
  line::Levels moved;
  moved.append_idle(kEdgesPerBit);
  bool level = true;
  for (std::size_t n = 0; n <= levels.size(); ++n) {
    if (levels[n] == level) continue;
    const auto edge = static_cast<std::int64_t>((n + 1) * kEdgesPerBit) + shift(level);
    moved.append_fill(level, static_cast<std::size_t>(edge) - moved.size());
    level = !level;
  }
  moved.append_idle(4 * kEdgesPerBit);
  return moved;
}

// The largest distance of an edge that left from the grid of its telegram, in bits.
double worst_edge(SlaveBench& bench);

}  // namespace fieldproof::conformance
