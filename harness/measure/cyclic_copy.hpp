#pragma once

#include <cstdint>

#include "harness/kernel/time.hpp"

// What a cyclic copy from an input to an output does to a binary signal, whatever the bus: closed forms for
// the width of a pulse and for what is lost. A measurement is held against these.
//
// Model: the input is sampled once a cycle, always at the same point of it, and what was sampled is shown at
// the output a constant time later. Edges come at random times relative to the cycle. Durations are rounded
// to the nearest picosecond. Computed for this project; the skew tests of a protocol have a simulation
// that shares no line with them.
namespace fieldproof::measure {

// A pulse of `high` leaves as a whole number of cycles: `cycles` of them, or one more with probability
// `probability_of_one_more`. `cycles` may be 0: then the pulse is lost unless it has one more.
struct PulseWidth {
  std::int64_t cycles;
  double probability_of_one_more;
  kernel::Duration shorter;  // `cycles` cycles
  kernel::Duration longer;
  kernel::Duration mean;                // equals `high`: the copy is unbiased
  kernel::Duration standard_deviation;  // over all pulses, lost ones count as 0
  kernel::Duration mean_absolute_error;
  double lost_probability;
};

PulseWidth pulse_width(kernel::Duration high, kernel::Duration cycle);

// Largest error of the duty cycle of a single period, as a part of the period.
double max_duty_error(double frequency_hz, kernel::Duration cycle);

// Highest frequency at which no pulse and no pause is ever lost: the shorter of both lasts one cycle. `duty`
// lies between 0 and 1. Where the cycle jitters, `longest_cycle` is the longest; where `lost_cycles` follow a
// rejected one, the distance of two samples is 1 + lost_cycles cycles.
double highest_frequency_hz(kernel::Duration longest_cycle, double duty = 0.5, unsigned lost_cycles = 0);

// The frequency that the output seems to have above the highest one.
double aliased_frequency_hz(double frequency_hz, kernel::Duration cycle);

}  // namespace fieldproof::measure
