// How many frames bursts corrupt, in closed form: what a laboratory's counts are held against, without a
// simulation.
//
// Frames of a number of random levels at any time, bursts as the standard names them (tolerances draw evenly
// around it), the receiver samples each level by itself. A pulse while a frame is on the line corrupts it
// with a chance that follows from the receiver's wrong output; the pulses of a frame are independent. What it
// does not have: start bits that are forced or lost, idle line between characters, edges that pulses move.
#pragma once

#include <cstdint>
#include <vector>

#include "emc/coupling.hpp"
#include "emc/generator.hpp"
#include "harness/line/sampling.hpp"

namespace fieldproof::emc {

// That a pulse on random levels makes at least one be sampled wrongly: 0 to 1.
double chance_of_hit(const WrongOutput& wrong, line::Sampling sampling, std::int64_t bit_rate);

class FrameHits {
 public:
  // `levels` and `bit_rate` are positive.
  FrameHits(unsigned levels, std::int64_t bit_rate, Repetition repetition);

  // The share of frames that are corrupted where a pulse fails to corrupt one with the probability
  // exp(-strength): 0 for 0, the share of frames that meet a pulse for infinity.
  double corrupted(double strength) const;

 private:
  std::vector<double> shares_;  // of frames with so many pulses, from one on
};

}  // namespace fieldproof::emc
