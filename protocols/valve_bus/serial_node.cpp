#include "protocols/valve_bus/serial_node.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/wall_clock_items.hpp"

namespace fieldproof::valve_bus {
namespace {

constexpr unsigned kMarginCharacters = 6;  // an answer of three, its driver, and a step
constexpr kernel::Duration kLeastStep = 30 * kernel::kMicrosecond;
constexpr kernel::Duration kPatience =
    2 * kernel::kSecond;                           // with what has been handed over and is not there
constexpr std::uint64_t kMostOctets = 1U << 20U;   // of a box within a case
constexpr std::uint64_t kMostUnasked = 1U << 14U;  // of a box behind what it was last sent
constexpr std::size_t kKeptDoubts = 256;

[[noreturn]] void refuse(const std::string& what) {
  throw iut::CannotBeDone("serial: " + what);
}

}  // namespace

SerialNode::SerialNode(SerialAttachment attachment, const NodeConfiguration& configuration,
                       const std::string& case_id, std::uint64_t seed)
    : attachment_(std::move(attachment)),
      configuration_(configuration),
      character_(character_time(configuration.rules)),
      step_(std::max(character_, kLeastStep)),
      // With an upper channel it is known how much is on its way, and waited for.
      margin_(kMarginCharacters * character_ + 2 * step_ +
              (attachment_.upper == nullptr ? 2 : 0) * attachment_.latency),
      codec_(configuration.rules),
      code_(character_format(configuration.rules)),
      transmitter_(configuration.rules) {
  guarded([&] {
    iut::SerialLine& line = *attachment_.line;
    line.set_clock(clock_);
    line.set(configuration.rules.bit_rate, serial_format(configuration.rules));
    line.look_every(std::clamp(character_ / 8, 20 * kernel::kMicrosecond, 200 * kernel::kMicrosecond));
    if (attachment_.upper != nullptr) {
      iut::CaseBegin begin{case_id, seed, node_settings(configuration)};
      begin.settings.emplace_back(kClockOrigin, clock_.origin());
      if (!attachment_.upper->begin(begin, *this)) {
        throw iut::Misbehaviour(iut::reasons::kUnsupported,
                                "the implementation answers 'unsupported' to this case");
      }
    }
    line.forget_arrived();  // what was still under way
    const kernel::Time begun = clock_.now();
    anchor_ = {kernel::kStart, {begun, begun}};
  });
}

SerialNode::~SerialNode() {
  try {
    end();
  } catch (const kernel::Error&) {
    // The case has ended before, with a verdict; the next one begins with a new channel.
  }
}

// One that did not keep to the protocol once is not called again.
template <typename Act>
void SerialNode::guarded(Act&& act) {
  if (!is_well_) return;
  is_well_ = false;
  try {
    act();
  } catch (const iut::CannotBeDone&) {
    is_well_ = true;  // the case asked for too much, and the node has done no wrong
    throw;
  }
  is_well_ = true;
}

void SerialNode::end() {
  if (!is_well_ || has_ended_) return;
  has_ended_ = true;
  guarded([&] {
    if (attachment_.upper != nullptr) attachment_.upper->end();
  });
  if (attachment_.on_well_ended) attachment_.on_well_ended();
}

NodeCapabilities SerialNode::reach() const {
  const bool has_upper = attachment_.upper != nullptr;
  return {.boards = has_upper, .moving_switches = false, .driver = has_upper, .distance = false};
}

TimingUncertainty SerialNode::doubt_of_answer(kernel::Time driver_on) const {
  const auto found = std::ranges::find(known_, driver_on, &Known::driver_on);
  return found == known_.end() ? TimingUncertainty{} : found->doubt;
}

void SerialNode::wire(segment::Port& line, NodeBoards& boards) {
  port_ = &line;
  boards_ = &boards;
}

kernel::Time SerialNode::wall_of(kernel::Time instant) const {
  return anchor_.wall.latest + (instant - anchor_.at);
}
kernel::Time SerialNode::instant_of(kernel::Time wall) const {
  return anchor_.at + (wall - anchor_.wall.latest);
}

void SerialNode::set_power(bool is_on, kernel::Time now) {
  guarded([&] {
    flush(now);
    if (attachment_.upper == nullptr) {
      if (!is_on || now != kernel::kStart)
        refuse("the supply of the box cannot be switched without an upper channel");
    } else {
      const kernel::Time switched = clock_.now();
      attachment_.upper->set_power(is_on, switched);
      anchor_ = {now, {switched, switched}};
    }
    sent_until_ = kernel::Time{kernel::Duration::min()};
    moves_.clear();
    transmitter_.begin_at(std::max(now, transmitter_.driven_until()));
    is_supplied_ = is_on;
    next_pump_ = now;
  });
}

kernel::Time SerialNode::next_time() const {
  if (!is_well_ || port_ == nullptr) return kernel::kNever;
  kernel::Time next = next_pump_;
  if (!pending_.empty()) next = std::min(next, sent_until_ + character_notice(configuration_.rules));
  if (!moves_.empty()) next = std::min(next, moves_.front().when);
  return next;
}

void SerialNode::on_time(kernel::Time now) {
  guarded([&] {
    now_ = now;
    if (!pending_.empty() && now >= sent_until_ + character_notice(configuration_.rules)) flush(now);
    pump(now);
    move_due(now);
    next_pump_ = now + step_;
  });
}

// ---- the tester's side ----

void SerialNode::expect_no_short_gap(kernel::Time start) const {
  if (sent_until_ == kernel::Time{kernel::Duration::min()}) return;
  const kernel::Duration gap = start - sent_until_;
  if (!pending_.empty() && std::chrono::abs(gap) <= kernel::kNanosecond) return;
  if (pending_.empty() && gap >= delimiter(configuration_.rules)) return;
  refuse(fmt::format("a gap of {} between two characters cannot be driven exactly", kernel::describe(gap)));
}

// A UART sends whole characters of its format at its bit rate.
void SerialNode::expect_drivable(const line::Waveform& wave, const HeardCharacter& character) const {
  line::Levels levels;
  code_.append(levels, written_character(configuration_.rules, character.octet()));
  if (wave.rate != configuration_.rules.bit_rate) refuse("characters at another bit rate cannot be driven");
  if (!character.is_good() || wave.levels != levels)
    refuse("levels that are no right character cannot be driven");
}

// The tester talks while the box does: into an answer, or because the box never stops.
void SerialNode::expect_an_answer() const {
  constexpr std::uint64_t kLongestAnswer = 64;
  if (arrived_ - arrived_before_ > kLongestAnswer) {
    throw iut::Misbehaviour(
        iut::reasons::kFloods,
        fmt::format("the implementation has sent {} octets, and talks while it should hear",
                    arrived_ - arrived_before_));
  }
  refuse("nothing can be sent into an answer");
}

void SerialNode::receive(segment::PortIndex, const line::Waveform& reception) {
  guarded([&] {
    now_ = reception.end();
    std::vector<HeardCharacter> characters;
    codec_.hear(reception, [&](const HeardCharacter& heard) { characters.push_back(heard); });
    if (characters.size() != 1) refuse("levels that are no right character cannot be driven");
    const HeardCharacter& character = characters.front();
    expect_drivable(reception, character);
    if (character.start < transmitter_.driven_until()) expect_an_answer();
    expect_no_short_gap(character.start);
    pending_.push_back(character.octet());
    sent_until_ = character.busy_until;
  });
}

void SerialNode::flush(kernel::Time now) {
  pump(now);
  if (pending_.empty()) return;
  // The node looks at its switches when it is called.
  if (attachment_.upper != nullptr) ask_upper(clock_.now());
  const iut::Stamp written = attachment_.line->write(pending_);
  sent_ += pending_.size();
  arrived_before_ = arrived_;
  pending_.clear();
  anchor_ = {sent_until_, {written.earliest, written.latest + attachment_.latency}};
  if (attachment_.upper != nullptr) wait_until_heard();
}

void SerialNode::wait_until_heard() {
  const kernel::Time begin = clock_.now();
  while (true) {
    ask_upper(clock_.now());
    if (heard_ >= sent_) return;
    if (clock_.now() - begin > kPatience) {
      throw iut::Misbehaviour(iut::reasons::kHangs,
                              fmt::format("the implementation has heard {} of {} octets", heard_, sent_));
    }
  }
}

// ---- the box's side ----

// All that happens up to `now` and the margin behind it is known afterwards.
void SerialNode::pump(kernel::Time now) {
  const kernel::Time until = wall_of(now) + margin_;
  while (const auto arrival = attachment_.line->read(until)) hear(*arrival);
  if (attachment_.upper == nullptr) {
    place_heard(now);
    return;
  }
  while (attachment_.upper->next_time() <= until) ask_upper(std::max(until, clock_.now()));
  await_said();
  place_said(now);
  if (!arrivals_.empty()) place_untold(now);
}

void SerialNode::hear(const iut::Arrival& arrival) {
  arrived_ += arrival.octets.size();
  const auto blame_flood = [](std::uint64_t most, const char* since) {
    throw iut::Misbehaviour(iut::reasons::kFloods,
                            fmt::format("the implementation has sent more than {} octets {}", most, since));
  };
  if (arrived_ - arrived_before_ > kMostUnasked)
    blame_flood(kMostUnasked, "since it was last sent something");
  if (arrived_ > kMostOctets) blame_flood(kMostOctets, "within a case");
  arrivals_.push_back(arrival);
}

void SerialNode::ask_upper(kernel::Time until) {
  attachment_.upper->on_time(until);
}

// What the node has written is on its way.
void SerialNode::await_said() {
  const kernel::Time begin = clock_.now();
  while (arrived_ < said_) {
    if (const auto arrival = attachment_.line->read(clock_.now() + kPatience / 8)) hear(*arrival);
    if (clock_.now() - begin > kPatience) {
      throw iut::Misbehaviour(
          iut::reasons::kImpossible,
          fmt::format("the implementation tells that it has sent {} octets; {} have come", said_, arrived_));
    }
  }
}

// Octets that have come and of which the upper channel says nothing.
void SerialNode::place_untold(kernel::Time now) {
  const kernel::Time asked = clock_.now();
  ask_upper(asked);
  await_said();
  place_said(now);
  if (!arrivals_.empty() && told_.empty() && arrivals_.front().stamp.latest < asked) place_heard(now);
}

// With an upper channel the node says what it has sent, and when; the octets are those of the line.
void SerialNode::place_said(kernel::Time now) {
  for (; !told_.empty() && told_.front().written != kernel::kNever; told_.pop_front()) {
    Said& said = told_.front();
    iut::Transmission& transmission = said.transmission;
    const auto length = static_cast<std::int64_t>(transmission.characters.size()) * character_;
    iut::Stamp end = arrivals_.empty() ? iut::Stamp{said.written, said.written} : arrivals_.front().stamp;
    for (std::uint16_t& character : transmission.characters) {
      if (arrivals_.empty()) break;
      std::vector<std::uint8_t>& octets = arrivals_.front().octets;
      character = static_cast<std::uint16_t>(written_character(configuration_.rules, octets.front()));
      end.latest = std::max(end.latest, arrivals_.front().stamp.latest);
      octets.erase(octets.begin());
      if (octets.empty()) arrivals_.pop_front();
    }
    // How late the system was to write it, and when it can have been written.
    const kernel::Duration slip = said.written - (transmission.start + length);
    kernel::Time earliest = std::min(end.earliest, said.written) - slip - length;
    if (transmission.driver_on - told_until_ <= kernel::kNanosecond)  // its driver has stayed on
      earliest = wall_of(transmitter_.driven_until()) + (transmission.start - transmission.driver_on);
    told_until_ = transmission.driver_off;
    place(transmission, earliest, end.latest - length, now);
  }
}

// Without one, what has come is all that is known. Characters follow each other unless they cannot.
void SerialNode::place_heard(kernel::Time now) {
  for (; !arrivals_.empty(); arrivals_.pop_front()) {
    const iut::Arrival& arrival = arrivals_.front();
    const auto length = static_cast<std::int64_t>(arrival.octets.size()) * character_;
    iut::Transmission transmission;
    for (const std::uint8_t octet : arrival.octets)
      transmission.characters.push_back(
          static_cast<std::uint16_t>(written_character(configuration_.rules, octet)));
    kernel::Time earliest = arrival.stamp.earliest - attachment_.latency - length;
    const bool goes_on = instant_of(earliest) <= said_until_;
    if (goes_on) earliest = wall_of(said_until_);
    const kernel::Duration driver = goes_on ? kernel::Duration{} : bits(configuration_.rules, 1);
    transmission.start = earliest;
    transmission.driver_on = earliest - driver;
    transmission.driver_off = earliest + length;
    place(transmission, earliest, std::max(earliest, arrival.stamp.latest - length), now);
  }
}

// `transmission` has its instants on the clock of the machine, its start between these two.
void SerialNode::place(iut::Transmission transmission, kernel::Time earliest, kernel::Time latest,
                       kernel::Time now) {
  if (!is_supplied_ || port_ == nullptr) return;
  const auto length = static_cast<std::int64_t>(transmission.characters.size()) * character_;
  const kernel::Duration before = transmission.start - transmission.driver_on;
  const kernel::Duration behind = transmission.driver_off - (transmission.start + length);
  const kernel::Time wanted = instant_of(earliest) - before;
  Known known;
  known.driver_on = std::max({wanted, now, transmitter_.driven_until()});
  known.doubt.earlier = known.driver_on - wanted;
  // An answer is measured from the end of what was sent, and that has a stamp of its own.
  known.doubt.later =
      std::max(kernel::Duration{},
               (latest - earliest) + (anchor_.wall.latest - anchor_.wall.earliest) - known.doubt.earlier);
  transmission.driver_on = known.driver_on;
  transmission.start = known.driver_on + before;
  said_until_ = transmission.start + length;
  transmission.driver_off = said_until_ + std::max(behind, kernel::Duration{});
  transmitter_.drive(*port_, transmission);
  known_.push_back(known);
  if (known_.size() > kKeptDoubts) known_.pop_front();
}

void SerialNode::move_due(kernel::Time now) {
  for (; !moves_.empty() && moves_.front().when <= now; moves_.pop_front())
    boards_->drive_valves(moves_.front().valves, moves_.front().when);
}

// ---- what the node tells through the upper channel ----

void SerialNode::transmit(const iut::Transmission& transmission) {
  told_.push_back({transmission, kernel::kNever});
}

void SerialNode::transmit(unsigned, line::Waveform&) {
  throw iut::Misbehaviour(iut::reasons::kImpossible,
                          "the implementation tells levels through its upper channel; it has characters");
}

void SerialNode::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  if (item == kHeardOctets) {
    heard_ = value;
    // What it does from now on it does behind this.
    if (heard_ == sent_) anchor_.wall.latest = std::max(anchor_.wall.earliest, when);
  } else if (item == kSaidOctets) {
    said_ = value;
    if (!told_.empty()) told_.back().written = when;
  } else if (item == kValves && value <= 0xFFFF) {
    const kernel::Time last = moves_.empty() ? now_ : std::max(now_, moves_.back().when);
    moves_.push_back({std::max(last, instant_of(when)), static_cast<std::uint16_t>(value)});
  } else {
    throw iut::Misbehaviour(
        iut::reasons::kImpossible,
        fmt::format("the implementation writes {} to item {} of its upper channel", value, item));
  }
}

std::uint64_t SerialNode::read(iut::Item item, kernel::Time) {
  if (item != kLimitSwitches || boards_ == nullptr) {
    throw iut::Misbehaviour(iut::reasons::kImpossible,
                            fmt::format("the implementation reads item {} of its upper channel", item));
  }
  return boards_->limit_switches(now_);
}

}  // namespace fieldproof::valve_bus
