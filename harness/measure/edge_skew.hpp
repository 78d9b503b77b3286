#pragma once

#include <cstdint>

#include "harness/measure/phase.hpp"
#include "harness/measure/two_channel_recorder.hpp"

// What lies between an input and the output that follows it, edge by edge: how late each edge is, how wrong
// the width of each pulse, and which pulses never came.
//
// Contract: an edge is late by the time from the input edge to the first instant at which the output shows
// it. A pulse lasts at the output from there until the output shows a later edge. A pulse is lost when the
// output never showed its rising edge, a pause when it never showed the falling edge in front of it; where a
// pause is lost, the output stays high over both pulses, which are told apart by the numbers of their edges.
// The rest after a train is no pause of the signal: the edge in front of it
// counts neither as late nor as lost. The last pulse of a record has no width when nothing follows it.
//
// A value belongs to the phase of the time from its first input edge to its last output edge.
namespace fieldproof::measure {

struct EdgeSkew {
  PhasedDistribution rise_delays;   // ps
  PhasedDistribution fall_delays;   // ps
  PhasedDistribution widths;        // ps, of the pulses that came
  PhasedDistribution width_errors;  // ps, output minus input
  // Of a single period: output minus input width, in millionths of the period.
  PhasedDistribution duty_errors_ppm;
  std::uint64_t pulses = 0;
  std::uint64_t lost_pulses = 0;
  std::uint64_t pauses = 0;  // between two pulses of one train
  std::uint64_t lost_pauses = 0;
  std::uint64_t foreign_words = 0;
};

EdgeSkew edge_skew(const TwoChannelRecorder& recorder, const PhaseDuring& phase_during = nullptr);

}  // namespace fieldproof::measure
