#include "harness/network/polled_bus.hpp"

#include <utility>

namespace fieldproof::network {

PolledBus::PolledBus(PolledBusSettings settings, std::uint64_t seed)
    : settings_(std::move(settings)),
      line_(segment_, "line", segment::ContentionRule::noise, kernel::Random(seed)),
      number_(segment_.attach(*this, "master")),
      master_(line_.attach("master/in", number_, 0, {})) {
  add_place(master_);
}

segment::Port& PolledBus::add(std::string name, segment::Station& responder, kernel::Duration distance) {
  segment::MediumPort& place = line_.attach(name + "/in", segment_.attach(responder, name), 0, distance);
  add_place(place);
  place.tap_driven(attendance_.expect(name));
  seats_.push_back({.station = &responder});
  signals_.push_back({.name = std::move(name), .bits = settings_.bits, .is_image = true});
  cycles_ = {{"poll cycle", cycle(), "so many slots as there are responders"}};
  return place;
}

void PolledBus::add_place(segment::MediumPort& place) {
  places_.push_back({.name = place.name(),
                     .receiver = &place,
                     .trace_channel = place.trace_channel(),
                     .level_rate = settings_.bit_rate,
                     .units = settings_.format,
                     .has_whole_units = true});
}

void PolledBus::start() {
  started_ = next_ = segment_.now();
  answered_.reset();
  attendance_.begin();
  slot_.reset();
  segment_.refresh(number_);
}

void PolledBus::stop() {
  next_ = kernel::kNever;
  segment_.refresh(number_);
}

State PolledBus::state() const {
  const kernel::Time now = segment_.now();
  if (answered_ && attendance_.is_complete()) {
    return now - *answered_ > 2 * cycle() ? State::stopped : State::exchanging;
  }
  const bool is_coming_up = next_ != kernel::kNever && now - started_ <= bring_up_limit();
  return is_coming_up ? State::coming_up : State::stopped;
}

RecoveryLimit PolledBus::recovery_limit() const {
  return {2 * seats_.size(), 2 * cycle(), "two poll cycles", judge::Standing::own};
}

void PolledBus::set_source(std::size_t signal, std::uint16_t word) {
  set_source_function(signal, [word](kernel::Time) { return word; });
}

void PolledBus::set_source_function(std::size_t signal, std::function<std::uint16_t(kernel::Time)> word) {
  seats_.at(signal).source = std::move(word);
}

std::uint16_t PolledBus::source(std::size_t n, kernel::Time now) const {
  const Seat& seat = seats_.at(n);
  return seat.source ? seat.source(now) : std::uint16_t{0};
}

void PolledBus::end() {
  for (Seat& seat : seats_) seat.station->end();
}

void PolledBus::receive(segment::PortIndex, const line::Waveform& wave) {
  if (!slot_ || outcome_ != Outcome::missing) return;
  const auto word = word_in(*slot_, wave);
  outcome_ = word ? Outcome::served : Outcome::rejected;
  if (!word) return;
  seats_[*slot_].image = *word;
  answered_ = segment_.now();
}

void PolledBus::on_time(kernel::Time now) {
  if (now < next_) return;
  if (slot_ && watcher_ != nullptr) {
    watcher_->on_exchange({.end = now, .outcome = outcome_, .first_signal = *slot_, .signal_count = 1});
  }
  slot_ = slot_ ? (*slot_ + 1) % seats_.size() : 0;
  if (*slot_ == 0 && watcher_ != nullptr) watcher_->on_cycle_begin(0, now);
  outcome_ = Outcome::missing;
  line::Waveform wave = request(*slot_, now);
  master_.drive(wave);
  next_ = now + settings_.slot;
}

}  // namespace fieldproof::network
