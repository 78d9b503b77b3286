#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>

#include "harness/kernel/time.hpp"

// The clock of the machine as time of a case: where a real line is, time passes by itself. It counts from an
// origin that two processes of one machine can agree on, so that what one has stamped the other can compare.
//
// This is the only place where real lines look at a clock.
namespace fieldproof::iut {

class WallClock {
 public:
  // Nanoseconds of the machine's monotonic clock.
  static std::int64_t machine_time() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }

  // Zero is now.
  WallClock() : WallClock(machine_time()) {}
  // Zero is that instant of the machine.
  explicit WallClock(std::int64_t origin) : origin_(origin) {}

  std::int64_t origin() const { return origin_; }
  kernel::Time now() const { return kernel::kStart + (machine_time() - origin_) * kernel::kNanosecond; }

  // What is left until then, for a call of the system that waits; zero when it has passed.
  static timespec wait_of(kernel::Duration left) {
    constexpr std::int64_t kPerSecond = 1'000'000'000;
    const std::int64_t rest = left <= kernel::Duration{} ? 0 : left / kernel::kNanosecond;
    timespec time{};
    time.tv_sec = static_cast<time_t>(rest / kPerSecond);
    time.tv_nsec = static_cast<long>(rest % kPerSecond);
    return time;
  }

 private:
  std::int64_t origin_;
};

// When something happened: not before the one, not after the other.
struct Stamp {
  kernel::Time earliest{};
  kernel::Time latest{};
};

}  // namespace fieldproof::iut
