#pragma once

#include <cstdint>
#include <vector>

#include "harness/measure/frequency.hpp"

// A function generator in gated mode: on each trigger it gives a train of periods of a square wave, and is
// low in between. Everything about it is a list of edge instants in whole picoseconds.
//
// Why trains: a generator that shares its time base with a cyclic bus meets the cycle at few phases only,
// where the period of the signal and the cycle are commensurable: at 50 Hz and a cycle of 0.8 ms every edge
// would come at the same point of the cycle, and a run would show one delay instead of all. Two devices of a
// laboratory have a time base each and drift past each other; here whoever triggers the trains gives each its
// phase.
//
// Contract: edges are counted from 1, odd ones rise, even ones fall. The k-th rising edge (from 0) of a train
// that is triggered at t comes at t + phase + k periods, its falling edge `duty` of a period later; each sum
// is rounded once. A train is triggered after the last edge before it.
namespace fieldproof::measure {

struct SquareWave {
  Frequency frequency = Frequency::from_hertz(50);
  std::int64_t duty_ppm = 500'000;  // high part of a period in millionths, 1 to 999 999
  kernel::Duration phase{};         // from the trigger to the first rising edge

  // One pulse, and one period.
  kernel::Duration high() const;
  kernel::Duration period() const { return frequency.periods(1); }
};

class SignalGenerator {
 public:
  explicit SignalGenerator(const SquareWave& wave);

  const SquareWave& wave() const { return wave_; }

  void trigger(kernel::Time at, std::int64_t periods);

  // All edges so far; edge n is edges()[n - 1].
  const std::vector<kernel::Time>& edges() const { return edges_; }
  kernel::Time edge(std::uint64_t number) const { return edges_.at(number - 1); }
  std::uint64_t pulse_count() const { return edges_.size() / 2; }
  // Between two pulses of one train; what lies after a train is a rest.
  std::uint64_t pause_count() const { return pulse_count() - train_ends_.size(); }
  // The last edge of a train, in front of a rest.
  bool is_train_end(std::uint64_t number) const;

  // Edges at or before an instant; the level there is high when it is odd.
  std::uint64_t edges_until(kernel::Time when) const;

 private:
  SquareWave wave_;
  std::vector<kernel::Time> edges_;
  std::vector<std::uint64_t> train_ends_;
};

}  // namespace fieldproof::measure
