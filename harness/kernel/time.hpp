// Virtual time: a signed count of picoseconds since the start of a run.
//
// Contract: 64 bit, so a run may last 106 days (9.2e18 ps) on either side of zero; `kNever` is the largest
// instant and means "no time is set". The instant of the n-th level of a line is computed from n itself and
// rounded once to the nearest picosecond (halves away from zero), so rounding errors never add up.
// Results past the range of 64 bit saturate at kNever (or its negative), they never wrap.
// Nothing here reads a clock of the machine.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <ratio>
#include <string>

namespace fieldproof::kernel {

// Picoseconds.
using Duration = std::chrono::duration<std::int64_t, std::pico>;

// The clock of the scheduler. It has no now(): only a scheduler knows what time it is.
struct VirtualClock {
  using duration = Duration;
  using rep = Duration::rep;
  using period = Duration::period;
  using time_point = std::chrono::time_point<VirtualClock, Duration>;
  static constexpr bool is_steady = true;
};

using Time = std::chrono::time_point<VirtualClock, Duration>;

inline constexpr Time kStart{Duration::zero()};
inline constexpr Time kNever{Duration::max()};

inline constexpr Duration kPicosecond{1};
inline constexpr Duration kNanosecond{1'000};
inline constexpr Duration kMicrosecond{1'000'000};
inline constexpr Duration kMillisecond{1'000'000'000};
inline constexpr Duration kSecond{1'000'000'000'000};

// How long `levels` levels last at `levels_per_second`: levels * 10^12 / rate, rounded once to the nearest
// picosecond. `levels_per_second` is positive; `levels` may be negative and is exact up to at least 2^40 in
// size. Where 10^12 % rate == 0 a caller may keep the duration of one level and multiply instead.
constexpr Duration levels_duration(std::int64_t levels, std::int64_t levels_per_second) {
  constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  constexpr std::uint64_t kPerSecond = 1'000'000'000'000;
  const bool negative = levels < 0;
  const std::uint64_t count =
      negative ? ~static_cast<std::uint64_t>(levels) + 1 : static_cast<std::uint64_t>(levels);
  const auto rate = static_cast<std::uint64_t>(levels_per_second);
  const std::uint64_t seconds = count / rate;
  const std::uint64_t rest = count % rate;
  if (seconds > kLargest / kPerSecond) {
    return negative ? -Duration::max() : Duration::max();
  }
  std::uint64_t fraction = 0;
  // Where 64 bit arithmetic has room it is used, in two steps at higher rates: a 128-bit division costs
  // several times as much.
  constexpr std::uint64_t kStep = 1'000'000;  // kPerSecond is its square
  if (rate <= 16'000'000) {
    fraction = (rest * kPerSecond + rate / 2) / rate;
  } else if (rate <= kLargest / kStep) {
    const std::uint64_t upper = rest * kStep;
    fraction = upper / rate * kStep + (upper % rate * kStep + rate / 2) / rate;
  } else {
    __extension__ using Wide = unsigned __int128;
    fraction = static_cast<std::uint64_t>((static_cast<Wide>(rest) * kPerSecond + rate / 2) / rate);
  }
  const std::uint64_t whole = seconds * kPerSecond;
  const std::uint64_t total = fraction > kLargest - whole ? kLargest : whole + fraction;
  const auto size = static_cast<std::int64_t>(total);
  return Duration{negative ? -size : size};
}

// The levels of a line that fit a duration, a begun one not counted: the inverse of levels_duration but for
// its rounding, which can make the answer one less. `duration` is not negative.
constexpr std::int64_t levels_within(Duration duration, std::int64_t levels_per_second) {
  constexpr std::int64_t kPerSecond = 1'000'000'000'000;
  std::int64_t product = 0;
  if (!__builtin_mul_overflow(duration.count(), levels_per_second, &product)) return product / kPerSecond;
  __extension__ using Wide = __int128;
  return static_cast<std::int64_t>(static_cast<Wide>(duration.count()) * levels_per_second / kPerSecond);
}

// The instant at which level `n` of a line begins that started at `start`.
constexpr Time level_time(Time start, std::int64_t n, std::int64_t levels_per_second) {
  const std::int64_t from = start.time_since_epoch().count();
  const std::int64_t length = levels_duration(n, levels_per_second).count();
  constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
  if (length >= 0 ? from > kLargest - length : from < -kLargest - length) {
    return Time{Duration{length >= 0 ? kLargest : -kLargest}};
  }
  return Time{Duration{from + length}};
}

// Exact text in the largest unit that gives a whole part, decimals in groups of three: "814.800 us",
// "1.000000500 ms", "750 ps", "0 s". An instant is told as the time since the start of the run, kNever as
// "never".
std::string describe(Duration duration);
std::string describe(Time time);

}  // namespace fieldproof::kernel
