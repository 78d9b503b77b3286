#include "harness/measure/cyclic_copy.hpp"

#include <algorithm>
#include <cmath>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

using kernel::Duration;

Duration nearest(double picoseconds) {
  return Duration{std::llround(picoseconds)};
}

double in_picoseconds(Duration duration) {
  return static_cast<double>(duration.count());
}

double in_seconds(Duration duration) {
  return in_picoseconds(duration) * 1e-12;
}

}  // namespace

PulseWidth pulse_width(Duration high, Duration cycle) {
  FIELDPROOF_CHECK(high >= Duration::zero() && cycle > Duration::zero(),
                   "a pulse has a width, a cycle a length");
  const std::int64_t cycles = high / cycle;
  const double more = in_picoseconds(high % cycle) / in_picoseconds(cycle);
  PulseWidth width{};
  width.cycles = cycles;
  width.probability_of_one_more = more;
  width.shorter = cycles * cycle;
  width.longer = (cycles + 1) * cycle;
  width.mean = high;
  width.standard_deviation = nearest(in_picoseconds(cycle) * std::sqrt(more * (1 - more)));
  width.mean_absolute_error = nearest(in_picoseconds(cycle) * 2 * more * (1 - more));
  width.lost_probability = cycles == 0 ? 1 - more : 0.0;
  return width;
}

double max_duty_error(double frequency_hz, Duration cycle) {
  return frequency_hz * in_seconds(cycle);
}

double highest_frequency_hz(Duration longest_cycle, double duty, unsigned lost_cycles) {
  FIELDPROOF_CHECK(duty > 0 && duty < 1, "a square wave has a pulse and a pause");
  return std::min(duty, 1 - duty) / (in_seconds(longest_cycle) * (1.0 + lost_cycles));
}

double aliased_frequency_hz(double frequency_hz, Duration cycle) {
  const double seconds = in_seconds(cycle);
  return std::abs(frequency_hz - std::round(frequency_hz * seconds) / seconds);
}

}  // namespace fieldproof::measure
