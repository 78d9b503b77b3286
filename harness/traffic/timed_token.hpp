#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "harness/kernel/time.hpp"
#include "harness/measure/distribution.hpp"

// The token of IEEE 802.4 without frames and levels: four access classes, of which the first has a holding
// time and each other one a target rotation time.
//
// At each visit class 6 sends until its holding time is over. Then classes 4, 2 and 0 follow: what the
// rotation timer of a class has left is its holding time in this visit, the timer is loaded with the target
// as service of the class begins, and a class whose timer has run out sends nothing. A frame that began in
// time is completed. Source: IEEE 802.4 as the access classes are described in public [searched]; the bound
// follows from it [derived].
namespace fieldproof::traffic {

enum class AccessClass : std::uint8_t { six, four, two, zero };
inline constexpr std::size_t kAccessClasses = 4;
std::string_view name_of(AccessClass access_class);  // "class 6"

struct TimedToken {
  unsigned stations = 2;                      // 2 to kMostTimedStations
  kernel::Duration pass{};                    // from the last frame of a visit to the next visit, above 0
  kernel::Duration hold{};                    // of class 6; 0: nobody uses it
  std::array<kernel::Duration, 3> targets{};  // of classes 4, 2 and 0; 0: the class is never served
  kernel::Duration longest_frame{};           // with what lies before it on the line, above 0
};

inline constexpr unsigned kMostTimedStations = 1'000;

// What is there to send. A station is asked as often as its timers allow.
class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  // The token has arrived.
  virtual void on_token(unsigned /*station*/, kernel::Time /*now*/) {}
  // How long the next frame takes, which begins now; nothing where there is none. `left`: of the holding
  // time, above 0.
  virtual std::optional<kernel::Duration> take(unsigned station, AccessClass access_class, kernel::Time now,
                                               kernel::Duration left) = 0;
};

struct TimedTokenFigures {
  measure::Distribution rotations;  // from one arrival at a station to its next, ps
  kernel::Duration longest_rotation{};
  std::array<std::uint64_t, kAccessClasses> frames{};  // by class
};

// Between two arrivals of the token at a station lie at most max( N (H + tau), T + L + (N - 1) H ), with H =
// THT + L (0 without class 6), L the longest frame, tau the pass and T the longest target; without lower
// classes the first.
kernel::Duration rotation_bound(const TimedToken& token);

// Throws kernel::Error(configuration) for what is outside of the ranges above, and for a source whose frame
// is longer than it may be. The timers begin run out, as in a station that comes into the ring.
TimedTokenFigures rotate_timed_token(const TimedToken& token, FrameSource& source, std::uint64_t visits);

}  // namespace fieldproof::traffic
