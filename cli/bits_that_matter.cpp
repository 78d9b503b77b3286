#include "cli/bits_that_matter.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "harness/fault/plan_file.hpp"

namespace fieldproof::cli {
namespace {

// A plan lists no more.
constexpr std::size_t kMostBits = 10'000;

// The last bits, at most so many of them and no more than a plan can list.
FlippedBits last_bits(const FlippedBits& struck, std::size_t most) {
  std::set<std::pair<kernel::Time, std::string>> disturbances;
  std::size_t count = 0;
  while (count < std::min({most, struck.size(), kMostBits})) {
    const StruckBit& one = struck[struck.size() - 1 - count];
    disturbances.emplace(one.from, one.receiver);
    if (disturbances.size() > fault::kMostDisturbances) break;
    ++count;
  }
  return {struck.end() - static_cast<std::ptrdiff_t>(count), struck.end()};
}

}  // namespace

// Bits that only bring another one to its place are left when each is taken away alone, and what came before
// may have been more than bits: so one alone of all that were struck is tried, too, from the last one on.
std::optional<FlippedBits> bits_that_matter(const FlippedBits& struck, const StillFails& still_fails) {
  constexpr std::size_t kMostTried = 256;
  auto fewest = fewest_of_the_last<StruckBit>(
      still_fails, [&struck](std::size_t most) { return last_bits(struck, most); });
  if (fewest && fewest->size() <= 1) return fewest;
  for (std::size_t n = 0; n < std::min(struck.size(), kMostTried); ++n) {
    FlippedBits alone{struck[struck.size() - 1 - n]};
    if (still_fails(alone)) return alone;
  }
  return fewest;
}

std::optional<FlippedBits> moved_bit_that_matters(const FlippedBits& struck, const StillFails& still_fails) {
  constexpr std::size_t kMostTried = 4;
  constexpr std::uint64_t kFarthest = 64;
  const std::size_t count = std::min(struck.size(), kMostTried);
  for (std::uint64_t far = 1; far <= kFarthest; ++far) {
    for (std::size_t n = 0; n < 2 * count; ++n) {
      StruckBit moved = struck[struck.size() - 1 - n / 2];
      const bool is_back = n % 2 == 0;
      if (is_back && moved.transmission < far) continue;
      moved.transmission = is_back ? moved.transmission - far : moved.transmission + far;
      if (still_fails({moved})) return FlippedBits{moved};
    }
  }
  return std::nullopt;
}

std::string bit_lines(const FlippedBits& bits) {
  std::string text;
  for (const StruckBit& one : bits) {
    text += fmt::format("  {} {} of transmission {} from {} on, as {} receives it\n",
                        one.is_level ? "level" : "bit", one.bit, one.transmission, kernel::describe(one.from),
                        one.receiver);
  }
  return text;
}

std::string change_lines(std::span<const trace::Change> changes, std::span<const std::string> channels,
                         const trace::Dissector& dissector) {
  std::string text;
  for (const trace::Change& change : changes) {
    text += fmt::format("  {}  {}  {}\n    sent      {}\n", kernel::describe(change.sent.start),
                        channels[change.channel], trace::describe(change), dissector.brief(change.sent));
    for (const line::Waveform& arrival : change.arrivals)
      text += fmt::format("    received  {}\n", dissector.brief(arrival));
  }
  return text;
}

}  // namespace fieldproof::cli
