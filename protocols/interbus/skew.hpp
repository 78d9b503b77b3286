#pragma once

#include <cstdint>

#include "harness/kernel/time.hpp"

// What a cyclic copy from an input to an output does to a binary signal: closed forms for the delay of an
// edge, the width of a pulse, and what is lost. A measurement is held against these.
//
// Model: inputs are sampled once a cycle, always at the same point of it; what was sampled in cycle k is
// copied by the master after cycle k and latched at the outputs in cycle k + 1. Edges come at random times
// relative to the cycle. Input filters and output switching times are not in the model: both are constants to
// add. Durations are rounded to the nearest picosecond. Computed for this project; skew_test.cpp has a
// simulation that shares no line with them.
namespace fieldproof::interbus {

// When inputs are sampled and outputs latched.
enum class LatchModel {
  same_instant,    // M1: inputs and outputs at the same instant of the pause between two cycles
  frame_edges,     // M2: inputs at the start of the frame, outputs at its end
  previous_frame,  // M3: inputs at the end of the frame before, outputs at the end of the frame
};

// Delay = waiting for the sample (uniform in one cycle) + `latency` from the sample to the latch.
struct EdgeDelay {
  kernel::Duration min;
  kernel::Duration mean;
  kernel::Duration max;
  kernel::Duration standard_deviation;
};

// `cycle` is the cycle time, `frame` the time from the sample at the start of a frame to the latch at its end
// (0 to `cycle`; only M2 depends on it).
kernel::Duration latency(LatchModel model, kernel::Duration cycle, kernel::Duration frame);
EdgeDelay edge_delay(LatchModel model, kernel::Duration cycle, kernel::Duration frame);

// Mean lag of the fundamental of a square wave, in degrees; above 360 the output is more than a period late.
double mean_phase_lag_degrees(LatchModel model, kernel::Duration cycle, kernel::Duration frame,
                              double frequency_hz);

// Mean delay of the rising edge of those pulses, not longer than a cycle, that are not lost.
kernel::Duration mean_delay_of_survivors(LatchModel model, kernel::Duration cycle, kernel::Duration frame,
                                         kernel::Duration high);

// Rejected cycles, independent, each with probability `reject_probability` below 1 and costing `lost_cycles`
// cycles until the next one that counts. An edge needs two good cycles, one to the master and one back.
double probability_of_no_extra_delay(double reject_probability);
// For an edge that comes while the bus works.
kernel::Duration mean_extra_delay(double reject_probability, unsigned lost_cycles, kernel::Duration cycle);
// For an edge at any instant: it may also come while the bus recovers, and then waits for the end of that.
// The same as above for one lost cycle.
kernel::Duration mean_extra_delay_at_any_instant(double reject_probability, unsigned lost_cycles,
                                                 kernel::Duration cycle);

}  // namespace fieldproof::interbus
