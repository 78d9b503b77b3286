#pragma once

#include <cstdint>

#include "harness/traffic/urgent_delay.hpp"

// The rules of the token that `urgent_delay` is a model of, as they are: a simulation of queues and rotations
// on the scheduler of virtual time, without frames and levels.
//
// At each node the token costs its overhead, then it is there: one urgent packet goes that has arrived by
// then; while the token has priority 1, one time-available packet goes that has arrived by the end of that. A
// rotation that took the target rotation time or more gives the next one priority 0, any other one
// priority 1; so has the first. A delay is from the arrival to the end of the transmission.
namespace fieldproof::traffic {

struct TokenRun {
  std::uint64_t seed = 1;
  std::uint64_t urgent_packets = 1'000'000;  // that are counted
  std::uint64_t warm_up_rotations = 10'000;  // before the first of them
  // Each visit finds a time-available packet, however many there were: what the token can carry at most.
  bool is_available_backlogged = false;
};

struct TokenFigures {
  // A queue of urgent packets has grown to `kMostWaiting`: what follows is of the time until then.
  bool is_urgent_unstable = false;

  std::uint64_t urgent_packets = 0;
  double mean_delay = 0;                // ms
  double standard_error = 0;            // of it, from the means of kBatches successive parts
  double mean_rotation = 0;             // ms
  double rotation_error = 0;            // standard error of it
  double priority_1 = 0;                // share of rotations
  double urgent_per_ms = 0;             // that left each queue
  double available_per_ms = 0;          // the same
  std::uint64_t longest_available = 0;  // time-available packets that wait in one queue at the end
};

inline constexpr std::uint64_t kMostWaiting = 1'000'000;
inline constexpr unsigned kBatches = 100;

// Throws as `urgent_delay` does; also for fewer packets than batches, and where no urgent packet ever comes.
TokenFigures rotate_token(const UrgentTraffic& traffic, const TokenRun& run);

// Time-available packets that each queue can send in a millisecond beside the urgent ones. One into which
// more arrive grows without end.
double available_capacity(const UrgentTraffic& traffic, std::uint64_t seed);

}  // namespace fieldproof::traffic
