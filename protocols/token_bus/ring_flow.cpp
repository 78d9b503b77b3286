#include "protocols/token_bus/ring_flow.hpp"

#include <utility>

namespace fieldproof::token_bus {

RingFlow::RingFlow(const RingData& data, std::uint8_t number, kernel::Random random)
    : data_(data), flow_(number), random_(std::move(random)) {
  const double gap_ms = static_cast<double>(data_.mean_gap().count()) / traffic::kPicosecondsPerMs;
  if (data_.load != 0) arrivals_.emplace(1 / gap_ms, random_);
}

// Stations began at different times: their periods are in no step.
void RingFlow::begin(kernel::Time now) {
  if (data_.every != kernel::Duration{}) {
    next_ = now + kernel::Duration{random_.between(0, data_.every.count() - 1)};
  } else if (arrivals_) {
    while (arrivals_->next() < now) arrivals_->draw();
    next_ = arrivals_->next();
  }
}

void RingFlow::stop() {
  next_ = kernel::kNever;
  waiting_.clear();
  given_.reset();
}

void RingFlow::take_due(kernel::Time now) {
  while (next_ <= now) {
    request(next_);
    if (arrivals_) {
      arrivals_->draw();
      next_ = arrivals_->next();
    } else {
      next_ += data_.every;
    }
  }
}

void RingFlow::request(kernel::Time when) {
  ++requests_;
  if (waiting_.size() < kMostWaiting) {
    waiting_.push_back(when);
  } else {
    ++refused_;
  }
}

std::optional<ServiceDatum> RingFlow::next_datum(std::uint16_t word) {
  if (!may_give()) return std::nullopt;
  given_ = Given{{flow_, number_++, word}, waiting_.front()};
  waiting_.pop_front();
  return given_->datum;
}

std::optional<kernel::Time> RingFlow::on_sent(const ServiceDatum& datum) {
  if (!given_ || given_->datum != datum || std::exchange(given_->is_sent, true)) return std::nullopt;
  return given_->requested;
}

}  // namespace fieldproof::token_bus
