#include "protocols/token_bus/watched_ring.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "protocols/token_bus/cable_rules.hpp"

namespace fieldproof::token_bus {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr unsigned kPulses = 75;
constexpr Duration kPulsePitch = 10 * kernel::kMicrosecond;
constexpr unsigned kNumberOctets = 4;  // of a datum
// Nobody of the ring: a station that hears its own address goes offline.
constexpr Address kStranger = 0x4000;

bool holds_token(AccessState state) {
  using enum AccessState;
  return state == use_token || state == await_ifm_response || state == check_access_class ||
         state == pass_token || state == await_response;
}

// One way along the longest segment.
Duration longest_way() {
  const CableRules rules;
  return Duration{rules.cable_delay_ps_per_m * rules.longest_segment_m};
}

}  // namespace

// ---- a station ----

void WatchedStation::receive(segment::PortIndex port, const line::Waveform& reception) {
  TokenStation::receive(port, reception);
  ring_.on_station(ring_.now());
}
void WatchedStation::on_activity(segment::PortIndex port, bool begins, Time now) {
  TokenStation::on_activity(port, begins, now);
  ring_.on_station(now);
}
void WatchedStation::on_time(Time now) {
  TokenStation::on_time(now);
  ring_.on_station(now);
}
void WatchedStation::on_token_taken(Time now) {
  has_had_token = true;
  ring_.submit_next(number_, now);
}
void WatchedStation::on_data(const Frame& frame, Time) {
  ring_.on_datum(number_, frame);
}

// ---- the ring ----

// Evenly along the cable, in half bits: so nobody's half bits lie between those of others.
void WatchedRing::add(unsigned n, const RecoverySettings& settings) {
  const StationConfiguration configuration{.rules = rules_, .address = 2 * Address{n} + 2};
  WatchedStation& station = stations_.emplace_back(*this, n, configuration, settings.drops_tokens);
  const Duration half_bit{kernel::kSecond.count() / (2 * rules_.phy_bit_rate)};
  const Duration position = n * longest_way().count() / (settings.stations - 1) / half_bit.count() * half_bit;
  const std::string name = "station@" + std::to_string(n + 1);
  seats_.push_back(segment_.attach(station, name));
  segment::MediumPort& place = line_.attach(name + "/in", seats_.back(), 0, position);
  place.sense_activity();
  station.wire(place, station);
}

void WatchedRing::set_power(std::size_t n, bool is_on) {
  WatchedStation& station = stations_[n];
  station.is_on = is_on;
  if (is_on) {
    station.start(now());
  } else {
    station.stop(now());
  }
  on_station(now());
  segment_.refresh(seats_[n]);
}

void WatchedRing::set_wanted(std::size_t n, bool is_wanted) {
  stations_[n].is_wanted = is_wanted;
  stations_[n].set_in_ring_desired(is_wanted, now());
  segment_.refresh(seats_[n]);
}

// Under each token a datum for the next station; one that leaves has none.
void WatchedRing::submit_next(std::size_t n, Time now) {
  WatchedStation& station = stations_[n];
  if (!station.is_wanted) return;
  ++station.sent;
  Octets data(kNumberOctets);
  for (unsigned octet = 0; octet < kNumberOctets; ++octet)
    data[octet] = static_cast<std::uint8_t>(station.sent >> 8 * octet);
  station.submit({.priority = 6, .destination = address(n + 1), .data = std::move(data)}, now);
}

void WatchedRing::on_datum(std::size_t at, const Frame& frame) {
  const auto number = static_cast<std::uint32_t>(address_of(frame.data));
  WatchedStation& station = stations_[at];
  ++figures.delivered;
  if (number == station.received) ++figures.delivered_twice;
  if (number < station.received) ++figures.out_of_order;
  station.received = number;
}

void WatchedRing::begin_watch() {
  for (WatchedStation& station : stations_) station.has_had_token = false;
  whole_at_ = kernel::kNever;
  watched_since_ = now();
}

bool WatchedRing::is_whole() const {
  std::size_t members = 0;
  for (const WatchedStation& station : stations_) {
    if (!station.is_member()) continue;
    if (!station.is_in_ring() || !station.has_had_token) return false;
    ++members;
  }
  // Along the successors from one of them: all, and then it again.
  const auto first = std::ranges::find_if(stations_, &WatchedStation::is_member);
  Address at = first->address();
  for (std::size_t n = 0; n < members; ++n) {
    const std::size_t number = (at - 2) / 2;
    if (number >= stations_.size() || !stations_[number].is_member()) return false;
    at = stations_[number].successor();
    if (at == first->address()) return n + 1 == members;
  }
  return false;
}

void WatchedRing::on_station(Time now) {
  const auto holders =
      std::ranges::count_if(stations_, [](const TokenStation& one) { return holds_token(one.state()); });
  if (double_since_) figures.longest_double = std::max(figures.longest_double, now - *double_since_);
  if (holders < 2) {
    double_since_.reset();
  } else if (!double_since_) {
    double_since_ = now;
  }
  if (whole_at_ == kernel::kNever && holders < 2 && is_done() && is_whole()) whole_at_ = now;
}

Time WatchedRing::run_until_whole(Duration limit) {
  const Time end = now() + limit;
  const Duration step = slots(rules_, 4);
  while (whole_at_ == kernel::kNever && now() < end) segment_.run_for(step);
  return whole_at_;
}

// ---- the tester ----

void WatchedRing::drive_at(Time when, unsigned pulses) {
  pulses_ = pulses;
  due_ = {when, 2 * rules_.phy_bit_rate, line::Levels::of_text("0")};
  wakes_at_ = when;
  segment_.refresh(tester_number_);
}

void WatchedRing::on_time(Time now) {
  if (now < wakes_at_) return;
  wakes_at_ = kernel::kNever;
  due_.start = now;
  tester_->drive(due_);
  if (pulses_ == 0) return;
  if (--pulses_ > 0) {
    drive_at(now + kPulsePitch, pulses_);
  } else {
    begin_watch();
  }
}

// What is driven begins now, or a little later.
void WatchedRing::on_wave(const line::Waveform& wave) {
  if (pulses_ > 0 || wakes_at_ != kernel::kNever || is_done()) return;
  const auto receptions = reader_.read(wave);
  const auto frame =
      receptions[0].kind == ReceptionKind::frame ? frame_of(receptions[0].octets, rules_) : std::nullopt;
  if (!frame) return;
  if (destroys_token_ && frame->kind == FrameKind::token) {
    destroys_token_ = false;
    // From the middle of it on.
    due_ = {wave.start + (wave.end() - wave.start) / 2, wave.rate, {}};
    due_.levels.append(random_.next(), 64);
    wakes_at_ = due_.start;
  } else if (second_token_to_) {
    due_ = {
        wave.end() + octets(rules_, 2), wave.rate,
        levels_of({.kind = FrameKind::token, .destination = *second_token_to_, .source = kStranger}, rules_)};
    second_token_to_.reset();
    wakes_at_ = due_.start;
  }
  begin_watch();
  segment_.refresh(tester_number_);
}

void WatchedRing::begin_burst() {
  drive_at(now(), kPulses);
}

}  // namespace fieldproof::token_bus
