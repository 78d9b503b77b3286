#include "harness/segment/link.hpp"

#include <algorithm>
#include <utility>

#include "harness/segment/past_drive.hpp"
#include "harness/segment/segment.hpp"
#include "harness/segment/stop.hpp"

namespace fieldproof::segment {

Link::Link(Segment& segment, std::string name, std::size_t receiver, PortIndex port, kernel::Duration delay)
    : segment_(segment),
      receiver_(receiver),
      port_(port),
      delay_(delay),
      trace_channel_(segment.trace().add_channel(std::move(name))),
      slot_(segment.scheduler().add(*this)) {}

const std::string& Link::name() const {
  return segment_.trace().channel_name(trace_channel_);
}

void Link::drive(line::Waveform& wave) {
  expect_not_past(name(), wave, segment_.now());
  FIELDPROOF_CHECK(wave.rate > 0, "a waveform has a rate");
  if (wave.start < driven_until_) ++overlap_count_;
  driven_until_ = std::max(driven_until_, wave.end());
  segment_.trace().driven(trace_channel_, wave);
  for (Tap* tap : driven_taps_) tap->on_wave(wave);
  launch(wave, wave.start + delay_, false);
  wave.levels.clear();
}

// Takes the levels of `wave` by exchange with a buffer that has already arrived, so nothing is allocated once
// a link is warm.
void Link::launch(line::Waveform& wave, kernel::Time arrival, bool passed) {
  if (head_ == tail_) head_ = tail_ = 0;
  if (tail_ == queue_.size()) {
    if (head_ > 0) {
      std::rotate(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(head_), queue_.end());
      tail_ -= head_;
      head_ = 0;
    } else {
      queue_.emplace_back();
    }
  }
  InFlight& flight = queue_[tail_++];
  flight.wave.start = arrival;
  flight.wave.rate = wave.rate;
  std::swap(flight.wave.levels, wave.levels);
  flight.passed = passed;
  // Only delayed and repeated transmissions overtake.
  for (std::size_t i = tail_ - 1; i > head_ && queue_[i].wave.start < queue_[i - 1].wave.start; --i) {
    std::swap(queue_[i], queue_[i - 1]);
  }
  if (tail_ - head_ == 1 || queue_[head_].wave.start < segment_.scheduler().armed(slot_)) arm();
}

void Link::arm() {
  if (head_ < tail_) segment_.scheduler().arm(slot_, queue_[head_].wave.start);
}

void Link::on_time(kernel::Time) {
  give_up_if_stopped();
  std::swap(arriving_, queue_[head_]);
  ++head_;
  arrive(arriving_);
  arm();
}

void Link::arrive(InFlight& flight) {
  if (!connected_) return;
  if (channel_ == nullptr || flight.passed || !channel_->pass(flight.wave, arrivals_)) {
    return deliver(flight.wave);
  }
  segment_.trace().changed(trace_channel_, flight.wave.start - delay_, flight.wave, arrivals_);
  // Taken out while the receiver is told, because what it drives may come through this link again.
  line::Waveforms arrivals = std::move(arrivals_);
  for (line::Waveform& arrival : arrivals) {
    if (arrival.start == segment_.now()) {
      deliver(arrival);
    } else {
      launch(arrival, arrival.start, true);
    }
  }
  arrivals.clear();
  arrivals_ = std::move(arrivals);
}

void Link::deliver(const line::Waveform& wave) {
  for (Tap* tap : arrived_taps_) tap->on_wave(wave);
  segment_.deliver(receiver_, port_, wave);
}

}  // namespace fieldproof::segment
