#pragma once

#include <cstdint>

#include "harness/traffic/urgent_delay.hpp"

// The experiment of Hong and Son as real stations on a simulated line: a scheduler and 16 nodes of FF-P at
// 1 Mbit/s, frame by frame. Each node has a queue of urgent and one of time-available packets, and gives its
// station one of each at most for each token, which is the single service of the paper; what has arrived by
// the time when the station begins to send goes with it.
//
// A packet takes the line for its frame and the silence after it: 75 and 267 octets, as in the paper. Slot
// time, silence and preamble are such that a rotation without packets takes the paper's 16 ms, one probe
// included; the paper's boards needed 1 ms for each node by their own slowness. The token has two steps.
namespace fieldproof::fieldbus_dll {

inline constexpr unsigned kExperimentNodes = 16;

struct ExperimentFigures {
  std::uint64_t urgent_packets = 0;
  double mean_delay = 0;      // ms, from the arrival to the end of the silence behind the frame
  double standard_error = 0;  // of it
  double mean_rotation = 0;   // ms
  double rotation_error = 0;  // standard error of it
  double priority_1 = 0;      // share of rotations that admit time-available data
  std::uint64_t rotations = 0;
  std::uint64_t longest_available = 0;  // time-available packets that wait at one node at the end
};

// For so long in virtual time, after three seconds in which nodes become live and queues fill. Rates
// and TTRT are those of the traffic, which otherwise must be `paper_traffic`; else, and for less than a
// second or more than a day, kernel::Error(configuration).
ExperimentFigures run_urgent_experiment(const traffic::UrgentTraffic& traffic, kernel::Duration duration,
                                        std::uint64_t seed);

}  // namespace fieldproof::fieldbus_dll
