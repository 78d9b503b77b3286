#include "protocols/token_bus/ring_recovery.hpp"

#include <algorithm>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "harness/kernel/check.hpp"
#include "harness/kernel/random.hpp"
#include "harness/segment/medium.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/token_bus/ring_network.hpp"
#include "protocols/token_bus/token_station.hpp"

namespace fieldproof::token_bus {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr unsigned kPulses = 75;
constexpr Duration kPulsePitch = 10 * kernel::kMicrosecond;
constexpr Duration kCable = 2'200 * kernel::kNanosecond;  // one way along a segment of 500 m
constexpr unsigned kNumberOctets = 4;                     // of a datum
// Nobody of the ring: a station that hears its own address goes offline.
constexpr Address kStranger = 0x4000;

bool holds_token(AccessState state) {
  using enum AccessState;
  return state == use_token || state == await_ifm_response || state == check_access_class ||
         state == pass_token || state == await_response;
}

class Ring;

// Tells the ring whenever it has been called: its state may be another one.
class WatchedStation final : public TokenStation, public StationUser {
 public:
  WatchedStation(Ring& ring, std::size_t number, const StationConfiguration& configuration, bool drops_tokens)
      : TokenStation(configuration), ring_(ring), number_(number), drops_tokens_(drops_tokens) {}

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_activity(segment::PortIndex port, bool begins, Time now) override;
  void on_time(Time now) override;
  void on_token_taken(Time now) override;
  bool drops_token_on(const Frame&) const override { return drops_tokens_; }
  void on_data(const Frame& frame, Time when) override;
  void on_event(const Event&, Time) override {}

  bool is_member() const { return is_on && is_wanted; }

  bool is_on = false;
  bool is_wanted = true;  // in the ring
  bool has_had_token = false;
  std::uint32_t sent = 0;
  std::uint32_t received = 0;  // the number of the last datum

 private:
  Ring& ring_;
  std::size_t number_;
  bool drops_tokens_;
};

class Ring final : private segment::Station, private segment::Tap {
 public:
  Ring(const RecoverySettings& settings)
      : rules_(settings.rules),
        reader_(rules_),
        random_(settings.seed),
        line_(segment_, "line", segment::ContentionRule::noise, random_) {
    line_.tap_driven(*this);
    tester_number_ = segment_.attach(*this, "tester");
    tester_ = &line_.attach("tester/in", tester_number_, 0, {});
    for (unsigned n = 0; n < settings.stations; ++n) add(n, settings);
  }

  // Until it is whole; kNever: not within `limit`.
  Time run_until_whole(Duration limit);
  // What is looked for is done since then.
  Time watched_since() const { return watched_since_; }
  void run_for(Duration duration) { segment_.run_for(duration); }
  Time now() const { return segment_.now(); }
  kernel::Random& random() { return random_; }
  std::size_t size() const { return stations_.size(); }
  Address address(std::size_t n) const { return 2 * Address{n % stations_.size()} + 2; }

  void set_power(std::size_t n, bool is_on);
  void set_wanted(std::size_t n, bool is_wanted);
  void destroy_next_token() { destroys_token_ = true; }
  void give_second_token(Address to) { second_token_to_ = to; }
  bool is_done() const { return !destroys_token_ && !second_token_to_ && pulses_ == 0; }
  void begin_burst() { drive_at(now(), kPulses); }
  void begin_watch();

  void on_station(Time now);
  void on_datum(std::size_t at, const Frame& frame);
  void submit_next(std::size_t n, Time now);

  RecoveryFigures figures;

 private:
  void add(unsigned n, const RecoverySettings& settings);
  bool is_whole() const;
  void drive_at(Time when, unsigned pulses);
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(Time now) override;
  Time next_time() const override { return wakes_at_; }
  void on_wave(const line::Waveform& wave) override;

  Rules rules_;
  FrameReader reader_;
  kernel::Random random_;
  segment::Segment segment_;
  segment::Medium line_;
  std::size_t tester_number_ = 0;
  segment::MediumPort* tester_ = nullptr;
  std::deque<WatchedStation> stations_;
  std::vector<std::size_t> seats_;
  bool destroys_token_ = false;
  std::optional<Address> second_token_to_{};
  unsigned pulses_ = 0;
  line::Waveform due_{};  // what the tester drives next
  Time wakes_at_ = kernel::kNever;
  std::optional<Time> double_since_{};
  Time whole_at_ = kernel::kNever;
  Time watched_since_ = kernel::kStart;
};

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
void Ring::add(unsigned n, const RecoverySettings& settings) {
  const StationConfiguration configuration{.rules = rules_, .address = 2 * Address{n} + 2};
  WatchedStation& station = stations_.emplace_back(*this, n, configuration, settings.drops_tokens);
  const Duration half_bit{kernel::kSecond.count() / (2 * rules_.phy_bit_rate)};
  const Duration position = n * kCable.count() / (settings.stations - 1) / half_bit.count() * half_bit;
  const std::string name = "station@" + std::to_string(n + 1);
  seats_.push_back(segment_.attach(station, name));
  segment::MediumPort& place = line_.attach(name + "/in", seats_.back(), 0, position);
  place.sense_activity();
  station.wire(place, station);
}

void Ring::set_power(std::size_t n, bool is_on) {
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

void Ring::set_wanted(std::size_t n, bool is_wanted) {
  stations_[n].is_wanted = is_wanted;
  stations_[n].set_in_ring_desired(is_wanted, now());
  segment_.refresh(seats_[n]);
}

// Under each token a datum for the next station; one that leaves has none.
void Ring::submit_next(std::size_t n, Time now) {
  WatchedStation& station = stations_[n];
  if (!station.is_wanted) return;
  ++station.sent;
  Octets data(kNumberOctets);
  for (unsigned octet = 0; octet < kNumberOctets; ++octet)
    data[octet] = static_cast<std::uint8_t>(station.sent >> 8 * octet);
  station.submit({.priority = 6, .destination = address(n + 1), .data = std::move(data)}, now);
}

void Ring::on_datum(std::size_t at, const Frame& frame) {
  const auto number = static_cast<std::uint32_t>(address_of(frame.data));
  WatchedStation& station = stations_[at];
  ++figures.delivered;
  if (number == station.received) ++figures.delivered_twice;
  if (number < station.received) ++figures.out_of_order;
  station.received = number;
}

void Ring::begin_watch() {
  for (WatchedStation& station : stations_) station.has_had_token = false;
  whole_at_ = kernel::kNever;
  watched_since_ = now();
}

bool Ring::is_whole() const {
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

void Ring::on_station(Time now) {
  const auto holders =
      std::ranges::count_if(stations_, [](const TokenStation& one) { return holds_token(one.state()); });
  if (holders < 2) {
    if (double_since_) figures.longest_double = std::max(figures.longest_double, now - *double_since_);
    double_since_.reset();
  } else if (!double_since_) {
    double_since_ = now;
  }
  if (whole_at_ == kernel::kNever && holders < 2 && is_done() && is_whole()) whole_at_ = now;
}

Time Ring::run_until_whole(Duration limit) {
  const Time end = now() + limit;
  const Duration step = slots(rules_, 4);
  while (whole_at_ == kernel::kNever && now() < end) segment_.run_for(step);
  return whole_at_;
}

// ---- the tester ----

void Ring::drive_at(Time when, unsigned pulses) {
  pulses_ = pulses;
  due_ = {when, 2 * rules_.phy_bit_rate, line::Levels::of_text("0")};
  wakes_at_ = when;
  segment_.refresh(tester_number_);
}

void Ring::on_time(Time now) {
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
void Ring::on_wave(const line::Waveform& wave) {
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

Duration limit_of(const RecoverySettings& settings) {
  RingDescription description = RingDescription::built_in(settings.stations);
  description.rules = settings.rules;
  return RingNetwork(description, settings.seed).recovery_limit().time;
}

// Done to station `n`; the ring is watched from then on.
void disturb(Ring& ring, Disturbance disturbance, std::size_t n) {
  switch (disturbance) {
    case Disturbance::nothing:
      break;
    case Disturbance::token_lost:
      ring.destroy_next_token();
      break;
    case Disturbance::token_doubled:
      ring.give_second_token(ring.address(n));
      break;
    case Disturbance::station_dies:
      ring.set_power(n, false);
      break;
    case Disturbance::station_comes:
      ring.set_power(n, true);
      break;
    case Disturbance::station_leaves:
      ring.set_wanted(n, false);
      break;
    case Disturbance::station_joins:
      ring.set_wanted(n, true);
      break;
  }
}

}  // namespace

std::string_view text_of(Disturbance disturbance) {
  constexpr std::array<std::string_view, kDisturbances> kTexts{
      "nothing else",    "a token is lost",  "a second token", "a station dies",
      "a station comes", "a station leaves", "a station joins"};
  return kTexts.at(static_cast<std::size_t>(disturbance));
}

RecoveryFigures recover(Disturbance disturbance, const RecoverySettings& settings) {
  FIELDPROOF_CHECK(settings.stations >= 3 && settings.stations <= 64,
                   "a ring that loses one has three or more");
  Ring ring(settings);
  for (std::size_t n = 0; n < ring.size(); ++n) ring.set_power(n, true);
  const Duration limit = limit_of(settings);
  const Duration patience = 10 * limit;
  FIELDPROOF_CHECK(ring.run_until_whole(patience) != kernel::kNever, "a ring of references comes up");
  ring.figures = RecoveryFigures();
  ring.figures.limit = limit;
  for (unsigned instant = 0; instant < settings.instants; ++instant) {
    const auto n =
        static_cast<std::size_t>(ring.random().between(0, static_cast<std::int64_t>(ring.size()) - 1));
    // What comes back has gone before, in a quiet ring.
    const bool comes = disturbance == Disturbance::station_comes;
    if (comes || disturbance == Disturbance::station_joins) {
      disturb(ring, comes ? Disturbance::station_dies : Disturbance::station_leaves, n);
      ring.begin_watch();
      ring.run_until_whole(patience);
    }
    ring.run_for(
        kernel::kPicosecond *
        ring.random().between(0, longest_rotation(RingDescription::built_in(settings.stations)).count()));
    ring.begin_watch();
    disturb(ring, disturbance, n);
    if (settings.has_bursts) ring.begin_burst();
    const Time whole = ring.run_until_whole(patience);
    const Duration after = whole == kernel::kNever ? patience : whole - ring.watched_since();
    ring.figures.whole_after.add(after);
    if (after > limit) ++ring.figures.beyond;
    if (disturbance == Disturbance::station_dies || disturbance == Disturbance::station_leaves) {
      disturb(
          ring,
          disturbance == Disturbance::station_dies ? Disturbance::station_comes : Disturbance::station_joins,
          n);
      ring.begin_watch();
      ring.run_until_whole(patience);
    }
  }
  return ring.figures;
}

Duration time_to_form(unsigned stations, const Rules& rules) {
  Ring ring({.stations = stations, .rules = rules});
  const Time begin = ring.now();
  for (std::size_t n = 0; n < ring.size(); ++n) ring.set_power(n, true);
  return ring.run_until_whole(100 * kernel::kSecond) - begin;
}

}  // namespace fieldproof::token_bus
