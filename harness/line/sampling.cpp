#include "harness/line/sampling.hpp"

#include <bit>

namespace fieldproof::line {

bool Sampling::sample(const Waveform& wave, kernel::Time edge, unsigned bit, std::int64_t bit_rate) const {
  if (kind == Kind::mid_bit) return wave.at(instant(edge, bit, 8, bit_rate));
  const kernel::Time first = instant(edge, bit, 7, bit_rate);
  const kernel::Time last = instant(edge, bit, 9, bit_rate);
  // On a quiet line the three samples lie in one level: its index is searched once.
  const std::size_t next = wave.first_level_at(first);
  const bool begins_here = next < wave.levels.size() && wave.time_of(next) == first;
  const std::size_t level = begins_here ? next : next - 1;
  const bool is_outside = first < wave.start || first >= wave.end();
  if (!is_outside && (level + 1 >= wave.levels.size() ? last < wave.end() : last < wave.time_of(level + 1))) {
    return wave.levels[level];
  }
  const int ones = int{wave.at(first)} + int{wave.at(instant(edge, bit, 8, bit_rate))} + int{wave.at(last)};
  return ones >= 2;
}

kernel::Time Sampling::idle_seen_at(const Waveform& wave, kernel::Time edge, std::int64_t bit_rate) const {
  const kernel::Time last = decided_at(edge, 0, bit_rate);
  return wave.at(last) ? last : instant(edge, 0, 8, bit_rate);
}

std::size_t falling_edge(const Levels& levels, std::size_t from) {
  const std::size_t size = levels.size();
  while (from < size) {
    const std::uint64_t here = levels.window(from);
    const bool before = from == 0 || levels[from - 1];
    const std::uint64_t edges = ~here & (here << 1 | std::uint64_t{before});
    if (edges != 0) {
      const std::size_t at = from + static_cast<std::size_t>(std::countr_zero(edges));
      return at < size ? at : size;
    }
    from += 64;
  }
  return size;
}

}  // namespace fieldproof::line
