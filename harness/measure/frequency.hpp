#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "harness/kernel/time.hpp"

// A frequency as a whole number of millihertz, so that the n-th period of a signal has an exact place in
// time.
namespace fieldproof::measure {

class Frequency {
 public:
  static constexpr std::int64_t kMostMillihertz = 1'000'000'000;  // 1 MHz

  // 1 to kMostMillihertz.
  static Frequency from_millihertz(std::int64_t millihertz);
  static Frequency from_hertz(std::int64_t hertz) { return from_millihertz(1'000 * hertz); }
  // "50Hz", "614.25 Hz", "1.5kHz", "0.1 MHz", "250 mHz" (millihertz); nothing for any other text, for more
  // than three decimals of a hertz and outside of the limits.
  static std::optional<Frequency> read(std::string_view text);

  std::int64_t millihertz() const { return millihertz_; }
  double hertz() const { return static_cast<double>(millihertz_) / 1e3; }
  // `count` periods, rounded once.
  kernel::Duration periods(std::int64_t count) const {
    return kernel::levels_duration(1'000 * count, millihertz_);
  }

  friend bool operator==(Frequency, Frequency) = default;

 private:
  explicit Frequency(std::int64_t millihertz) : millihertz_(millihertz) {}

  std::int64_t millihertz_;
};

std::string describe(Frequency frequency);  // "614.25 Hz"

}  // namespace fieldproof::measure
