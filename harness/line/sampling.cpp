#include "harness/line/sampling.hpp"

#include <bit>

namespace fieldproof::line {

namespace {

// The length of so many sixteenths of a bit in levels at `rate`.
struct LevelCount {
  std::size_t whole;
  std::size_t rounded_up;
};

LevelCount levels_in(std::uint64_t sixteenths, std::int64_t rate, std::int64_t bit_rate) {
  __extension__ using Wide = unsigned __int128;
  const Wide product = Wide{sixteenths} * static_cast<std::uint64_t>(rate);
  const auto divisor = static_cast<std::uint64_t>(bit_rate) * 16;
  const auto whole = static_cast<std::size_t>(product / divisor);
  return {whole, whole + (product % divisor != 0 ? 1 : 0)};
}

}  // namespace

void Sampler::fit(std::int64_t rate) {
  rate_ = rate;
  for (unsigned bit = 0; bit < kMostBits; ++bit) {
    const LevelCount last = levels_in(bit * 16 + sampling_.last(), rate, bit_rate_);
    places_.at(bit) = {levels_in(bit * 16 + sampling_.first(), rate, bit_rate_).whole,
                       levels_in(bit * 16 + 8, rate, bit_rate_).whole, last.whole, last.rounded_up};
  }
  behind_first_middle_ = levels_in(8, rate, bit_rate_).rounded_up;
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
