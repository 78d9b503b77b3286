#include "conformance/token_bus/ring_around.hpp"

#include <algorithm>

namespace fieldproof::conformance {
namespace {

constexpr std::int64_t kPauseOctets = 8;

}  // namespace

void RingAround::live(kernel::Duration duration) {
  const kernel::Time end = bench_.now() + duration;
  while (const auto one = bench_.next(end)) tester_.reply_to(*one);
}

void RingAround::settle() {
  constexpr unsigned kMostFrames = 60;
  constexpr unsigned kMostWindows = 2;
  kernel::Duration silence = quiet();
  unsigned windows = 0;
  bool is_in_windows = false;
  is_alone_ = false;
  for (unsigned n = 0; n < kMostFrames && windows < kMostWindows; ++n) {
    const auto one = bench_.next(bench_.now() + silence);
    if (one) {
      // Only the next frame shows that the windows before it passed in silence.
      windows = is_in_windows ? windows + 1 : 0;
      const bool is_replied_to = tester_.reply_to(*one);
      is_in_windows = one->is(TokenControl::solicit_2) && !is_replied_to;
      continue;
    }
    twin_.catch_up(bench_.now());
    const auto until = twin_.awaited_until();
    if (!until || *until <= bench_.now()) return;
    silence = *until - bench_.now() + bench_.octets(1);
  }
  is_alone_ = windows == kMostWindows;
  bench_.wait(bench_.octets(kPauseOctets));
}

bool RingAround::goes_round() {
  constexpr unsigned kMostFrames = 60;
  bench_.send(bench_.frame(TokenControl::token, bench_.address(), TokenBench::kAbove));
  for (unsigned n = 0; n < kMostFrames; ++n) {
    const auto one = bench_.next(bench_.now() + quiet());
    if (!one) return false;
    const bool is_taken = tester_.reply_to(*one);
    if (!is_taken || !one->is(TokenControl::token)) continue;
    bench_.wait(bench_.octets(kPauseOctets));
    return true;
  }
  return false;
}

// Never silent for so long that a station claims the token.
bool RingAround::goes_slowly(std::int64_t slots) {
  const token_bus::Rules& rules = bench_.rules();
  const std::int64_t idle = std::min(rules.bus_idle_slots, rules.lowest_bus_idle_slots);
  for (std::int64_t left = slots; left > 0;) {
    const std::int64_t silent = std::min(left, std::max<std::int64_t>(1, idle / 2));
    left -= silent;
    live(bench_.slots(silent));
    bench_.send(bench_.data_frame(kDataOfSix, TokenBench::kBelow, TokenBench::kStranger, Octets{0x33}));
  }
  bench_.wait(bench_.octets(kPauseOctets));
  return goes_round();
}

void RingAround::fail(std::int64_t times) {
  constexpr unsigned kMostFrames = 30;
  is_alone_ = false;
  for (std::int64_t n = 0; n < times; ++n) {
    bench_.send(bench_.frame(TokenControl::solicit_1, TokenBench::kBelow, TokenBench::kAbove));
    bench_.next(bench_.now() + bench_.slots(1));
    bench_.wait(bench_.octets(kPauseOctets));
    bench_.send(bench_.frame(TokenControl::token, bench_.address(), TokenBench::kAbove));
    // The windows of the last stage are the longest silence.
    for (unsigned frames = 0; frames < kMostFrames && bench_.next(bench_.now() + bench_.slots(4));) ++frames;
  }
}

void RingAround::claim(std::int64_t times) {
  constexpr unsigned kMostFrames = 60;
  const std::int64_t idle = std::max(bench_.rules().bus_idle_slots, bench_.rules().lowest_bus_idle_slots);
  for (std::int64_t n = 0; n < times; ++n) {
    for (unsigned frames = 0; frames < kMostFrames; ++frames) {
      const auto one = bench_.next(bench_.now() + bench_.slots(idle + 2));
      if (!one) return;
      if (one->is(TokenControl::solicit_2)) break;
    }
    bench_.wait(bench_.octets(kPauseOctets));
    bench_.send(bench_.data_frame(kDataOfSix, TokenBench::kBelow, TokenBench::kStranger, Octets{0x33}));
  }
}

}  // namespace fieldproof::conformance
