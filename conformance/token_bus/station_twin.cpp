#include "conformance/token_bus/station_twin.hpp"

#include <algorithm>

namespace fieldproof::conformance {

Observations frames_of(std::span<const DrivenFrame> driven) {
  Observations all;
  for (const DrivenFrame& one : driven) all.push_back({{one.octets.begin(), one.octets.end()}, one.begin});
  return all;
}

Observations indications_of(const TokenUser& user, const token_bus::Rules& rules) {
  Observations all;
  for (const token_bus::Frame& one : user.frames) {
    const Octets octets = token_bus::octets_of(one, rules);
    all.push_back({{octets.begin(), octets.end()}, {}});
  }
  return all;
}

TokenTwin::TokenTwin(const token_bus::StationConfiguration& configuration, segment::MediumPort& tester,
                     kernel::Time now)
    : line_(segment_, "line", segment::ContentionRule::noise, kernel::Random(1)),
      rules_(configuration.rules),
      station_(configuration),
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

void TokenTwin::on_wave(const line::Waveform& wave) {
  segment_.run_until(std::max(wave.start, segment_.now()));
  line::Waveform copy = wave;
  tester_->drive(copy);
}

bool TokenTwin::submit(const token_bus::DataRequest& request, kernel::Time now) {
  run_until(now);
  const bool is_taken = station_.submit(request, now);
  segment_.refresh(seat_);
  return is_taken;
}

void TokenTwin::set_in_ring_desired(bool is_desired, kernel::Time now) {
  run_until(now);
  station_.set_in_ring_desired(is_desired, now);
  segment_.refresh(seat_);
}

void TokenTwin::set_response(const Octets& data, kernel::Time now) {
  run_until(now);
  station_.set_response(data, now);
  segment_.refresh(seat_);
}

Observations TokenTwin::frames() const {
  return frames_of(driven_.all());
}

kernel::Time TokenTwin::last_begin() const {
  return driven_.all().empty() ? kernel::kStart : driven_.all().back().begin;
}

Observations TokenTwin::indications() const {
  return indications_of(user_, rules_);
}

}  // namespace fieldproof::conformance
