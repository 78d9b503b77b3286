#include "harness/iut/wall_clock_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/iut/misbehaviour.hpp"

namespace fieldproof::iut {
namespace {

constexpr unsigned kMarginCharacters = 6;  // an answer of three, its driver, and a step
constexpr kernel::Duration kLeastStep = 30 * kernel::kMicrosecond;
constexpr kernel::Duration kHandOverLimit =
    2 * kernel::kSecond;                           // for what has been handed over and is not there
constexpr std::uint64_t kMostOctets = 1U << 20U;   // of a box within a case
constexpr std::uint64_t kMostUnasked = 1U << 14U;  // of a box after what it was last sent

[[noreturn]] void refuse(const std::string& what) {
  throw CannotBeDone("serial: " + what);
}

}  // namespace

Capabilities WallClockDevice::capabilities() const {
  const bool has_upper = attachment_.upper != nullptr;
  return {.process_side = has_upper,
          .moving_inputs = false,
          .driver_control = has_upper,
          .distance = false,
          .power = has_upper,
          .is_wall_clock = true};
}

bool WallClockDevice::begin(const CaseBegin& begin, Bench& bench) {
  bench_ = &bench;
  clock_ = WallClock();
  attachment_.line->set_clock(clock_);
  set_line(make_uart_(begin));
  if (attachment_.upper != nullptr) {
    CaseBegin of_box = begin;
    of_box.settings.emplace_back(kClockOrigin, clock_.origin());
    if (!attachment_.upper->begin(of_box, *this)) return false;
  }
  attachment_.line->forget_arrived();  // what was still under way
  const kernel::Time begun = clock_.now();
  anchor_ = {kernel::kStart, {begun, begun}};
  return true;
}

void WallClockDevice::set_line(const UartLine& uart) {
  uart_ = uart;
  character_ = uart_.character_time();
  step_ = std::max(character_, kLeastStep);
  // With an upper channel it is known how much is on its way, and waited for.
  margin_ = kMarginCharacters * character_ + 2 * step_ +
            (attachment_.upper == nullptr ? 2 : 0) * attachment_.latency;
  attachment_.line->set(uart_.bit_rate, uart_.eight_bit_format());
  attachment_.line->look_every(
      std::clamp(character_ / 8, 20 * kernel::kMicrosecond, 200 * kernel::kMicrosecond));
}

void WallClockDevice::end() {
  if (attachment_.upper != nullptr) attachment_.upper->end();
}

void WallClockDevice::set_anchor(const Anchor& anchor) {
  anchor_ = anchor;
  bench_->set_uncertainty({{}, anchor_.wall.latest - anchor_.wall.earliest});
}

void WallClockDevice::set_power(bool is_on, kernel::Time now) {
  now_ = now;
  if (is_supplied_) flush(now);
  is_supplied_ = is_on;
  was_asked_ = false;
  writes_.clear();
  if (attachment_.upper == nullptr) {
    if (!is_on || now != kernel::kStart)
      refuse("the supply of the box cannot be switched without an upper channel");
  } else {
    const kernel::Time switched = clock_.now();
    set_anchor({now, {switched, switched}});
    attachment_.upper->set_power(is_on, switched);
  }
  sent_until_ = kernel::Time{kernel::Duration::min()};
  driven_until_ = std::max(now, driven_until_);
  next_pump_ = now;
}

kernel::Time WallClockDevice::next_time() const {
  if (bench_ == nullptr || !is_supplied_) return kernel::kNever;
  kernel::Time next = next_pump_;
  if (!pending_.empty()) next = std::min(next, sent_until_ + uart_.character_notice());
  if (!writes_.empty()) next = std::min(next, writes_.front().when);
  return next;
}

void WallClockDevice::on_time(kernel::Time now) {
  now_ = now;
  if (!pending_.empty() && now >= sent_until_ + uart_.character_notice()) flush(now);
  pump(now);
  write_due(now);
  next_pump_ = now + step_;
}

// ---- the tester's side ----

void WallClockDevice::receive(unsigned, const line::Waveform&) {
  refuse("levels cannot be driven");
}

void WallClockDevice::receive(unsigned port, std::span<const Character> characters, kernel::Time now) {
  now_ = now;
  if (port != 0) return ask(port, characters, now);
  for (const Character& character : characters) send(character);
}

// What the box does within this call it does now; instants after it are as far from those of the line as
// before.
void WallClockDevice::ask(unsigned port, std::span<const Character> characters, kernel::Time now) {
  if (attachment_.upper == nullptr) refuse("nothing can be asked of the box without an upper channel");
  flush(now);
  was_asked_ = uart_.latest_answer > kernel::Duration{};
  const kernel::Time asked = clock_.now();
  std::vector<Character> passed_on(characters.begin(), characters.end());
  for (Character& one : passed_on) one.start = one.busy_until = asked;
  is_asking_ = true;
  attachment_.upper->receive(port, passed_on, asked);
  is_asking_ = false;
  write_due(now);
}

// A UART sends whole characters of its format at its bit rate.
void WallClockDevice::send(const Character& character) {
  const auto octet = static_cast<std::uint8_t>(character.data);
  if (character.is_parity_wrong || character.is_stop_missing || uart_.character_of(octet) != character.data)
    refuse("levels that are no right character cannot be driven");
  if (character.start < driven_until_) expect_an_answer();
  expect_no_short_gap(character.start);
  if (pending_.empty()) {
    sent_from_ = character.start;
    asked_before_ = sent_from_ - placed_until_;
    asked_at_ = ended_at_;
  }
  pending_.push_back(octet);
  sent_until_ = character.busy_until;
}

void WallClockDevice::expect_no_short_gap(kernel::Time start) const {
  if (sent_until_ == kernel::Time{kernel::Duration::min()}) return;
  const kernel::Duration gap = start - sent_until_;
  if (!pending_.empty() && std::chrono::abs(gap) <= kernel::kNanosecond) return;
  if (pending_.empty() && gap >= uart_.shortest_silence) return;
  refuse(fmt::format("a gap of {} between two characters cannot be driven exactly", kernel::describe(gap)));
}

// The tester talks while the box does: into an answer, or because the box never stops.
void WallClockDevice::expect_an_answer() const {
  constexpr std::uint64_t kLongestAnswer = 64;
  if (arrived_ - arrived_before_ > kLongestAnswer) {
    throw Misbehaviour(reasons::kFloods,
                       fmt::format("the implementation has sent {} octets, and sends while it should receive",
                                   arrived_ - arrived_before_));
  }
  refuse("nothing can be sent into an answer");
}

void WallClockDevice::flush(kernel::Time now) {
  pump(now);
  if (pending_.empty()) return;
  expect_in_time(asked_at_);
  // The box looks at its inputs when it is called.
  if (attachment_.upper != nullptr) ask_upper(clock_.now());
  const Stamp written = attachment_.line->write(pending_);
  const auto length = static_cast<std::int64_t>(pending_.size()) * character_;
  sent_ += pending_.size();
  arrived_before_ = arrived_;
  pending_.clear();
  set_anchor({sent_until_, {written.earliest, written.latest + attachment_.latency}});
  if (attachment_.upper == nullptr) return;
  wait_until_received();
  expect_in_time(anchor_.wall.latest - length);
}

// The box begins to receive what was an answer in time as the case has it: not later than it waits, by its
// own clock, and before it asks anew.
void WallClockDevice::expect_in_time(kernel::Time received) const {
  const bool is_answer = uart_.latest_answer > kernel::Duration{} && asked_at_ != kernel::kNever &&
                         asked_before_ <= uart_.latest_answer;
  if (!is_answer) return;
  if (received - asked_at_ <= uart_.latest_answer && ended_at_ == asked_at_) return;
  throw InDoubt(
      fmt::format("serial: an answer of the tester that was to begin {} after a request has come later "
                  "than the box waits, {}",
                  kernel::describe(asked_before_), kernel::describe(uart_.latest_answer)));
}

void WallClockDevice::wait_until_received() {
  const kernel::Time begin = clock_.now();
  while (true) {
    ask_upper(clock_.now());
    if (received_ >= sent_) return;
    if (clock_.now() - begin > kHandOverLimit) {
      throw Misbehaviour(reasons::kHangs,
                         fmt::format("the implementation has received {} of {} octets", received_, sent_));
    }
  }
}

// ---- the box's side ----

// Who asks goes on while the bench is kept from running: its requests are repeated, its orders given up.
void WallClockDevice::expect_no_delay(kernel::Duration delay) const {
  if (!was_asked_ || delay <= uart_.latest_answer / 2) return;
  throw InDoubt(
      fmt::format("serial: this machine has kept the bench from running for {}, and the box waits {}",
                  kernel::describe(delay), kernel::describe(uart_.latest_answer)));
}

// All that happens up to `now` and the margin after it is known afterwards.
void WallClockDevice::pump(kernel::Time now) {
  const kernel::Time until = wall_of(now) + margin_;
  expect_no_delay(clock_.now() - until);
  while (const auto arrival = attachment_.line->read(until)) keep(*arrival);
  if (attachment_.upper == nullptr) {
    place_arrived(now);
    return;
  }
  while (attachment_.upper->next_time() <= until) ask_upper(std::max(until, clock_.now()));
  await_reported();
  place_reported(now);
  if (!arrivals_.empty()) place_unreported(now);
}

void WallClockDevice::keep(const Arrival& arrival) {
  arrived_ += arrival.octets.size();
  const auto blame_flood = [](std::uint64_t most, const char* since) {
    throw Misbehaviour(reasons::kFloods,
                       fmt::format("the implementation has sent more than {} octets {}", most, since));
  };
  if (arrived_ - arrived_before_ > kMostUnasked)
    blame_flood(kMostUnasked, "since it was last sent something");
  if (arrived_ > kMostOctets) blame_flood(kMostOctets, "within a case");
  arrivals_.push_back(arrival);
}

// What the box has written is on its way.
void WallClockDevice::await_reported() {
  const kernel::Time begin = clock_.now();
  while (arrived_ < reported_) {
    if (const auto arrival = attachment_.line->read(clock_.now() + kHandOverLimit / 8)) keep(*arrival);
    if (clock_.now() - begin > kHandOverLimit) {
      throw Misbehaviour(reasons::kImpossible,
                         fmt::format("the implementation reports that it has sent {} octets; {} have come",
                                     reported_, arrived_));
    }
  }
}

// Octets that have come and of which the upper channel says nothing.
void WallClockDevice::place_unreported(kernel::Time now) {
  const kernel::Time asked = clock_.now();
  ask_upper(asked);
  await_reported();
  place_reported(now);
  if (!arrivals_.empty() && reports_.empty() && arrivals_.front().stamp.latest < asked) place_arrived(now);
}

// With an upper channel the box reports what it has sent, and when; the octets are those of the line.
void WallClockDevice::place_reported(kernel::Time now) {
  for (; !reports_.empty() && reports_.front().written != kernel::kNever; reports_.pop_front()) {
    Sent& sent = reports_.front();
    UartTransmission& transmission = sent.transmission;
    const auto length = static_cast<std::int64_t>(transmission.characters.size()) * character_;
    Stamp end = arrivals_.empty() ? Stamp{sent.written, sent.written} : arrivals_.front().stamp;
    for (std::uint16_t& character : transmission.characters) {
      if (arrivals_.empty()) break;
      std::vector<std::uint8_t>& octets = arrivals_.front().octets;
      character = uart_.character_of(octets.front());
      end.latest = std::max(end.latest, arrivals_.front().stamp.latest);
      octets.erase(octets.begin());
      if (octets.empty()) arrivals_.pop_front();
    }
    // How late the system was to write it, and when it can have been written.
    const kernel::Duration slip = sent.written - (transmission.start + length);
    kernel::Time earliest = std::min(end.earliest, sent.written) - slip - length;
    if (transmission.driver_on - reported_until_ <= kernel::kNanosecond)  // its driver has stayed on
      earliest = wall_of(driven_until_) + (transmission.start - transmission.driver_on);
    reported_until_ = transmission.driver_off;
    ended_at_ = transmission.start + length;
    // One that asks is judged by what it does after what it has received, and both are on its own clock.
    const bool is_asker = uart_.latest_answer > kernel::Duration{};
    const kernel::Time start = transmission.start;
    if (is_asker) {
      place(transmission, start, start, now);
    } else {
      place(transmission, earliest, end.latest - length, now);
    }
  }
}

// Without one, what has come is all that is known. Characters follow each other unless they cannot.
void WallClockDevice::place_arrived(kernel::Time now) {
  for (; !arrivals_.empty(); arrivals_.pop_front()) {
    const Arrival& arrival = arrivals_.front();
    const auto length = static_cast<std::int64_t>(arrival.octets.size()) * character_;
    UartTransmission transmission;
    for (const std::uint8_t octet : arrival.octets)
      transmission.characters.push_back(uart_.character_of(octet));
    kernel::Time earliest = arrival.stamp.earliest - attachment_.latency - length;
    const bool goes_on = instant_of(earliest) <= placed_until_;
    if (goes_on) earliest = wall_of(placed_until_);
    const kernel::Duration bit = uart_.bits(1);
    const kernel::Duration driver = goes_on ? kernel::Duration{} : bit;
    transmission.start = earliest;
    transmission.driver_on = earliest - driver;
    transmission.driver_off = earliest + length;
    place(transmission, earliest, std::max(earliest, arrival.stamp.latest - length), now);
  }
}

// `transmission` has its instants on the clock of the machine, its start between these two.
void WallClockDevice::place(UartTransmission transmission, kernel::Time earliest, kernel::Time latest,
                            kernel::Time now) {
  if (!is_supplied_) return;
  const auto length = static_cast<std::int64_t>(transmission.characters.size()) * character_;
  const kernel::Duration before = transmission.start - transmission.driver_on;
  const kernel::Duration after = transmission.driver_off - (transmission.start + length);
  const kernel::Time wanted = instant_of(earliest) - before;
  transmission.driver_on = std::max({wanted, now, driven_until_});
  TimingUncertainty uncertainty;
  uncertainty.earlier = transmission.driver_on - wanted;
  // An answer is measured from the end of what was sent, and that has a stamp of its own.
  uncertainty.later =
      std::max(kernel::Duration{},
               (latest - earliest) + (anchor_.wall.latest - anchor_.wall.earliest) - uncertainty.earlier);
  transmission.start = transmission.driver_on + before;
  placed_until_ = transmission.start + length;
  transmission.driver_off = placed_until_ + std::max(after, kernel::Duration{});
  driven_until_ = transmission.driver_off;
  bench_->set_uncertainty(uncertainty);
  bench_->set_driver(0, true, transmission.driver_on);
  bench_->send(0, transmission.start, transmission.characters);
  bench_->set_driver(0, false, transmission.driver_off);
  set_anchor(anchor_);
}

void WallClockDevice::write_due(kernel::Time now) {
  for (; !writes_.empty() && writes_.front().when <= now; writes_.pop_front())
    bench_->write(writes_.front().item, writes_.front().value, now);
}

// ---- what the box reports through the upper channel ----

void WallClockDevice::set_driver(unsigned, bool is_on, kernel::Time at) {
  if (is_on) {
    reported_on_ = at;
  } else if (!reports_.empty() && reports_.back().written == kernel::kNever) {
    reports_.back().transmission.driver_off = at;
  }
}

// Of a box that does not say when its driver went off it is the end of the characters.
void WallClockDevice::send(unsigned, kernel::Time start, std::span<const std::uint16_t> characters) {
  const kernel::Time end = start + static_cast<std::int64_t>(characters.size()) * character_;
  const kernel::Time driver_on = std::min(std::exchange(reported_on_, kernel::kNever), start);
  reports_.push_back({{driver_on, start, end, {characters.begin(), characters.end()}}, kernel::kNever});
}

void WallClockDevice::transmit(unsigned, line::Waveform&) {
  throw Misbehaviour(reasons::kImpossible,
                     "the implementation reports levels through its upper channel; it has characters");
}

void WallClockDevice::write(Item item, std::uint64_t value, kernel::Time when) {
  if (item == kReceivedOctets) {
    received_ = value;
    // What it does from now on it does after this.
    if (received_ == sent_) {
      Anchor anchor = anchor_;
      anchor.wall.latest = std::max(anchor.wall.earliest, when);
      set_anchor(anchor);
    }
  } else if (item == kSentOctets) {
    reported_ = value;
    if (!reports_.empty()) reports_.back().written = when;
  } else {
    if (is_asking_) when = wall_of(now_);
    const kernel::Time last = writes_.empty() ? now_ : std::max(now_, writes_.back().when);
    writes_.push_back({std::max(last, instant_of(when)), item, value});
  }
}

std::uint64_t WallClockDevice::read(Item item, kernel::Time) {
  return bench_->read(item, now_);
}

}  // namespace fieldproof::iut
