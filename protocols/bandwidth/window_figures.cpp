#include "protocols/bandwidth/window_figures.hpp"

#include <algorithm>

namespace fieldproof::bandwidth {

using kernel::Duration;

Duration WindowFigures::longest() const {
  Duration longest{};
  for (const StreamFigures& stream : streams) longest = std::max(longest, stream.longest);
  return longest;
}

std::uint64_t WindowFigures::over_slot() const {
  std::uint64_t sum = 0;
  for (const StreamFigures& stream : streams) sum += stream.over_slot;
  return sum;
}

std::uint64_t WindowFigures::lost() const {
  std::uint64_t sum = 0;
  for (const StreamFigures& stream : streams) sum += stream.replaced;
  for (const LoopFigures& loop : loops) sum += loop.lost;
  return sum;
}

std::uint64_t WindowFigures::vacant() const {
  std::uint64_t sum = 0;
  for (const LoopFigures& loop : loops) sum += loop.vacant;
  return sum;
}

std::uint64_t WindowFigures::samplings() const {
  std::uint64_t sum = 0;
  for (const LoopFigures& loop : loops) sum += loop.samplings;
  return sum;
}

void WindowFigures::add(const WindowFigures& one) {
  for (std::size_t n = 0; n < streams.size(); ++n) {
    StreamFigures& to = streams[n];
    const StreamFigures& from = one.streams[n];
    to.generated += from.generated;
    to.delivered += from.delivered;
    to.replaced += from.replaced;
    to.over_slot += from.over_slot;
    to.longest = std::max(to.longest, from.longest);
    to.sum += from.sum;
  }
  for (std::size_t n = 0; n < loops.size(); ++n) {
    loops[n].samplings += one.loops[n].samplings;
    loops[n].vacant += one.loops[n].vacant;
    loops[n].lost += one.loops[n].lost;
    loops[n].longest_delay = std::max(loops[n].longest_delay, one.loops[n].longest_delay);
  }
  real_time.sent += one.real_time.sent;
  non_real_time.sent += one.non_real_time.sent;
  slots += one.slots;
  visits += one.visits;
  longest_of_start = std::max(longest_of_start, one.longest_of_start);
}

}  // namespace fieldproof::bandwidth
