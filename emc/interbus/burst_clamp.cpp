#include "emc/interbus/burst_clamp.hpp"

#include <utility>

namespace fieldproof::emc {

BurstClamp::BurstClamp(const BurstSettings& bursts, WrongOutput wrong, const BurstReceiver& receiver,
                       const kernel::Random& random, kernel::Duration recovery)
    : bursts_(bursts),
      wrong_(std::move(wrong)),
      receiver_(receiver),
      random_(random),
      recovery_(recovery),
      schedule_(bursts_, random_) {}

void BurstClamp::couple(interbus::Ring& ring, segment::Segment& segment, kernel::Time on, kernel::Time off) {
  bursts_.on = on;
  bursts_.off = off;
  // Equal streams: all receivers of a run, and whoever asks for its phases, see the same pulses.
  schedule_ = BurstSchedule(bursts_, random_);
  channels_.clear();
  for (segment::Link* link : ring.remote_links()) {
    channels_.emplace_back(BurstSchedule(bursts_, random_), wrong_, receiver_, segment.trace(),
                           link->trace_channel());
    link->set_channel(&channels_.back());
  }
}

measure::Phase BurstClamp::phase_during(kernel::Time from, kernel::Time to) {
  const BurstTiming& timing = schedule_.timing();
  const kernel::Duration burst = timing.pulses * timing.pitch + 2 * timing.jitter;
  bool is_recovery = false;
  for (kernel::Time pulse = schedule_.first_from(from - recovery_ - burst); pulse != kernel::kNever;) {
    const BurstSchedule::Window window = schedule_.window_of(pulse);
    if (window.from >= to) break;
    if (window.to > from) return measure::Phase::burst;
    is_recovery = is_recovery || window.to + recovery_ > from;
    pulse = schedule_.first_from(window.to + timing.jitter);
  }
  return is_recovery ? measure::Phase::recovery : measure::Phase::quiet;
}

}  // namespace fieldproof::emc
