#include "conformance/token_bus/station_twin.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::conformance {

Observations frames_of(std::span<const DrivenFrame> driven) {
  Observations all;
  for (const DrivenFrame& one : driven) all.push_back({{one.octets.begin(), one.octets.end()}, one.begin});
  return all;
}

Observations indications_of(std::span<const token_bus::Frame> frames, const token_bus::Rules& rules) {
  Observations all;
  for (const token_bus::Frame& one : frames) {
    const Octets octets = token_bus::octets_of(one, rules);
    all.push_back({{octets.begin(), octets.end()}, {}});
  }
  return all;
}

Observations events_of(std::span<const TokenUser::Reported> events) {
  Observations all;
  for (const TokenUser::Reported& one : events) {
    all.push_back({{static_cast<std::int64_t>(one.event.kind), static_cast<std::int64_t>(one.event.address)},
                   one.when});
  }
  return all;
}

TokenTwin::TokenTwin(const token_bus::StationConfiguration& configuration, segment::MediumPort& tester,
                     const DrivenFrames& followed, kernel::Time now)
    : line_(segment_, "line", segment::ContentionRule::noise, kernel::Random(1)),
      station_(configuration, followed),
      driven_(configuration.rules.phy_bit_rate, token_bus::address_octets(configuration.rules)) {
  tester_ = &line_.attach("tester/in", segment_.attach(*this, "tester"), 0, {});
  seat_ = segment_.attach(station_, "reference");
  segment::MediumPort& place = line_.attach("reference/in", seat_, 0, {});
  place.sense_activity();
  place.tap_driven(driven_);
  station_.wire(place, user_);
  segment_.run_until(now);
  station_.start(now);
  segment_.refresh(seat_);
  tester.tap_driven(*this);
}

void TokenTwin::keep(kernel::Time when, std::function<void(kernel::Time)> act) {
  acts_.push_back({when, std::move(act)});
}

void TokenTwin::on_wave(const line::Waveform& wave) {
  keep(wave.start, [this, wave](kernel::Time) {
    line::Waveform copy = wave;
    tester_->drive(copy);
  });
}

void TokenTwin::set_power(bool is_on, kernel::Time now) {
  keep(now, [this, is_on](kernel::Time when) { is_on ? void(station_.start(when)) : station_.stop(when); });
}

void TokenTwin::submit(const token_bus::DataRequest& request, kernel::Time now) {
  keep(now, [this, request](kernel::Time when) { taken_.push_back(station_.submit(request, when)); });
}

void TokenTwin::set_in_ring_desired(bool is_desired, kernel::Time now) {
  keep(now, [this, is_desired](kernel::Time when) { station_.set_in_ring_desired(is_desired, when); });
}

void TokenTwin::set_response(const Octets& data, kernel::Time now) {
  keep(now, [this, data](kernel::Time when) { station_.set_response(data, when); });
}

// What it waits for has changed with what the other has driven since.
void TokenTwin::catch_up(kernel::Time now) {
  segment_.refresh(seat_);
  for (; !acts_.empty(); acts_.pop_front()) {
    const kernel::Time when = std::max(acts_.front().when, segment_.now());
    segment_.run_until(when);
    acts_.front().act(when);
    segment_.refresh(seat_);
  }
  segment_.run_until(now);
}

}  // namespace fieldproof::conformance
