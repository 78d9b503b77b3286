#include "protocols/interbus/skew.hpp"

#include <algorithm>
#include <cmath>

#include "harness/kernel/check.hpp"

namespace fieldproof::interbus {

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

Duration latency(LatchModel model, Duration cycle, Duration frame) {
  FIELDPROOF_CHECK(frame >= Duration::zero() && frame <= cycle, "a frame lasts at most one cycle");
  switch (model) {
    case LatchModel::same_instant:
      return cycle;
    case LatchModel::frame_edges:
      return cycle + frame;
    case LatchModel::previous_frame:
      return 2 * cycle;
  }
  FIELDPROOF_CHECK(false, "every latch model has its line above");
  return cycle;
}

EdgeDelay edge_delay(LatchModel model, Duration cycle, Duration frame) {
  const Duration least = latency(model, cycle, frame);
  return {least, least + nearest(in_picoseconds(cycle) / 2), least + cycle,
          nearest(in_picoseconds(cycle) / std::sqrt(12.0))};
}

double mean_phase_lag_degrees(LatchModel model, Duration cycle, Duration frame, double frequency_hz) {
  return 360.0 * frequency_hz * in_seconds(edge_delay(model, cycle, frame).mean);
}

Duration mean_delay_of_survivors(LatchModel model, Duration cycle, Duration frame, Duration high) {
  FIELDPROOF_CHECK(high <= cycle, "pulses longer than a cycle all survive");
  return latency(model, cycle, frame) + nearest(in_picoseconds(high) / 2);
}

double probability_of_no_extra_delay(double reject_probability) {
  return (1 - reject_probability) * (1 - reject_probability);
}

Duration mean_extra_delay(double reject_probability, unsigned lost_cycles, Duration cycle) {
  FIELDPROOF_CHECK(reject_probability >= 0 && reject_probability < 1, "some cycles must get through");
  return nearest(2.0 * lost_cycles * in_picoseconds(cycle) * reject_probability / (1 - reject_probability));
}

Duration mean_extra_delay_at_any_instant(double reject_probability, unsigned lost_cycles, Duration cycle) {
  // Of all time, this part belongs to a recovery, and an edge in it waits half of the other lost cycles.
  const double recovering = lost_cycles * reject_probability;
  const double part = recovering / (1 - reject_probability + recovering);
  const double wait = lost_cycles == 0 ? 0.0 : part * (lost_cycles - 1.0) / 2;
  return mean_extra_delay(reject_probability, lost_cycles, cycle) + nearest(wait * in_picoseconds(cycle));
}

}  // namespace fieldproof::interbus
