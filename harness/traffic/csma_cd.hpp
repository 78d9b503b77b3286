#pragma once

#include <cstdint>

#include "harness/kernel/time.hpp"
#include "harness/measure/distribution.hpp"

// The access of IEEE 802.3 without frames and levels: 1-persistent carrier sense with collision detection, a
// truncated binary exponential backoff, and a frame that is given up after 16 attempts.
//
// A station that has a frame waits for the line to be idle for an inter-frame gap and begins at once; who
// begins within the propagation time of another collides with it. All stop a jam after the last of them can
// be received everywhere, and after its k-th collision of a frame a station waits r slots more, r evenly from
// 0 to 2^min(k, 10) - 1. Between any two stations the propagation time is the same, the longest one of the
// line: no place on it is better. After a collision the line is idle for all at one instant, which lets those
// begin a propagation time early who were not in it: that favours this access.
// Source: ISO/IEC 8802-3 clause 4 [sure].
namespace fieldproof::traffic {

struct CsmaCd {
  unsigned stations = 2;     // 1 to kMostCsmaStations
  double per_ms = 0;         // frames that arrive at each of them as a Poisson stream, above 0
  kernel::Duration frame{};  // on the line, preamble included; at least a slot
  // Of 10 Mbit/s: 512, 32 and 96 bit times, and half a slot for the longest way.
  kernel::Duration slot = 51'200 * kernel::kNanosecond;
  kernel::Duration jam = 3'200 * kernel::kNanosecond;
  kernel::Duration gap = 9'600 * kernel::kNanosecond;
  kernel::Duration propagation = 25'600 * kernel::kNanosecond;
};

inline constexpr unsigned kMostCsmaStations = 1'024;
inline constexpr unsigned kMostAttempts = 16;

struct CsmaRun {
  std::uint64_t seed = 1;
  std::uint64_t frames = 100'000;  // that end or are given up, counted from the first on
  kernel::Duration bound{};        // of which `beyond` tells
};

struct CsmaFigures {
  measure::Distribution
      delays;  // of frames that were sent, from the arrival to the end of the transmission, ps
  std::uint64_t sent = 0;
  std::uint64_t given_up = 0;
  std::uint64_t collisions = 0;
  std::uint64_t first_collisions = 0;  // in which no frame had collided before
  std::uint64_t beyond = 0;            // sent later than the bound
  double carried = 0;                  // share of time in which frames that are no collision are on the line
  std::uint64_t longest_queue = 0;
};

// Throws kernel::Error(configuration) for what is outside of the ranges above. A queue of more than 100,000
// frames ends the run: more arrives than the line can carry.
CsmaFigures run_csma_cd(const CsmaCd& line, const CsmaRun& run);

}  // namespace fieldproof::traffic
