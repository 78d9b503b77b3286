#include "protocols/token_bus/ring_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/config/name.hpp"
#include "harness/kernel/check.hpp"
#include "protocols/token_bus/token_station.hpp"

namespace fieldproof::token_bus {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr unsigned kMostRingStations = 64;
constexpr std::size_t kWordOctets = 3;  // number of the signal, and the word
constexpr unsigned kWordPriority = 6;
// A window opens after so many tokens of a station at most.
constexpr std::int64_t kTokensUntilWindow = 20;

Duration gap_of(const Rules& rules) {
  return octets(rules, rules.response_gap_octets);
}

RingData read_ring_data(const config::Value& value) {
  return config::read_object(value, [](config::ObjectReader& object) {
    return RingData{object.required("from").as_integer<Address>(),
                    object.required("to").as_integer<Address>()};
  });
}

bool is_in(const std::vector<Address>& stations, Address address) {
  return std::ranges::find(stations, address) != stations.end();
}

}  // namespace

RingDescription RingDescription::built_in(unsigned stations) {
  RingDescription ring;
  ring.name = fmt::format("ring of {} stations", stations);
  for (unsigned n = 0; n < stations; ++n) ring.stations.push_back(2 * (n + 1));
  for (unsigned n = 0; n < stations; ++n)
    ring.data.push_back({ring.stations[n], ring.stations[(n + 1) % stations]});
  return ring;
}

RingDescription RingDescription::read(const config::Value& root) {
  const RingDescription ring = config::read_object(root, [](config::ObjectReader& object) {
    RingDescription read;
    object.optional("$schema");
    read.name = config::read_name(object.required("name"));
    for (const config::Value& one : object.required("stations").as_array(2, kMostRingStations))
      read.stations.push_back(one.as_integer<Address>());
    for (const config::Value& one : object.required("data").as_array(1))
      read.data.push_back(read_ring_data(one));
    return read;
  });
  if (const auto violation = violation_of(ring)) config::fail(root, *violation);
  return ring;
}

RingDescription RingDescription::load(const std::filesystem::path& path) {
  const config::Document document = config::Document::load(path);
  return read(document.root());
}

std::optional<std::string> violation_of(const RingDescription& ring) {
  for (std::size_t n = 0; n < ring.stations.size(); ++n) {
    const Address address = ring.stations[n];
    if (address == 0 || is_group(address) || address > broadcast(ring.rules))
      return fmt::format("station {}: an address is even, from 2 to 65534, because an odd one is a group's",
                         address);
    if (std::ranges::count(ring.stations, address) > 1)
      return fmt::format("station {} is there twice; each has its own address", address);
  }
  if (ring.data.size() > 256) return fmt::format("{} words: 256 are the most", ring.data.size());
  for (const RingData& data : ring.data) {
    if (!is_in(ring.stations, data.from) || !is_in(ring.stations, data.to) || data.from == data.to)
      return fmt::format("data from {} to {}: write two different addresses of \"stations\"", data.from,
                         data.to);
  }
  return std::nullopt;
}

Duration longest_rotation(const RingDescription& ring) {
  const Rules& rules = ring.rules;
  const auto stations = static_cast<std::int64_t>(ring.stations.size());
  const auto words = static_cast<std::int64_t>(ring.data.size());
  // A window is closed when its slot times are over; the lowest opens two.
  return stations * (2 * (frame_time(rules, 0) + gap_of(rules)) + slots(rules, 1)) + slots(rules, 1) +
         words * (frame_time(rules, kWordOctets) + gap_of(rules));
}

// ---- the running ring ----

RingNetwork::RingNetwork(const RingDescription& description, std::uint64_t seed, const RingStations& stations)
    : description_(description),
      random_(seed),
      line_(segment_, "line", segment::ContentionRule::noise, random_),
      tester_(description.rules) {
  FIELDPROOF_CHECK(!violation_of(description_), "a ring that runs is one within its limits");
  line_.tap_driven(*this);
  // A word that waits for a token outlives each one that is lost: it is late, not wrong.
  constexpr unsigned kMostWaiting = 16;
  for (const RingData& data : description_.data) {
    signals_.push_back({.name = fmt::format("word of station {} at station {}", data.from, data.to),
                        .admissible_words = kMostWaiting});
    words_.add_signal();
  }
  waits_.assign(signals_.size(), false);
  for (std::size_t n = 0; n < description_.stations.size(); ++n)
    add(description_.stations[n], n + 1, stations);
  cycles_.push_back({.name = "token rotation",
                     .theory = longest_rotation(description_),
                     .form = "all words, and a response window of each station",
                     .is_bound = true});
}

void RingNetwork::add(Address address, std::size_t position, const RingStations& stations) {
  const StationConfiguration configuration{.rules = description_.rules, .address = address};
  Seat& seat = seats_.emplace_back();
  seat.address = address;
  seat.device = stations.make ? stations.make(position, configuration) : nullptr;
  const bool is_under_test = seat.device != nullptr;
  if (!is_under_test) seat.device = std::make_unique<TokenStation>(configuration);
  seat.user = std::make_unique<User>(*this, address);
  const std::string name = fmt::format("station@{}", position);
  seat.number = segment_.attach(*seat.device, name);
  segment::MediumPort& place = line_.attach(name + "/in", seat.number, 0, {});
  place.sense_activity();
  if (is_under_test) place.tap_driven(attendance_.expect(name));
  seat.device->wire(place, *seat.user);
  // Levels are half bits.
  places_.push_back({.name = place.name(),
                     .receiver = &place,
                     .trace_channel = place.trace_channel(),
                     .level_rate = 2 * description_.rules.phy_bit_rate});
}

void RingNetwork::start() {
  if (!std::exchange(has_tester_, true)) tester_number_ = segment_.attach(*this, "tester");
  if (is_on_) stop();
  started_ = segment_.now();
  is_on_ = true;
  for (Seat& seat : seats_) seat.device->start(started_);
  attendance_.begin();
  words_.begin();
  for (std::size_t n = 0; n < words_.size(); ++n) give(n, started_);
  set_wake();
  for (const Seat& seat : seats_) segment_.refresh(seat.number);
}

void RingNetwork::stop() {
  is_on_ = false;
  last_token_ = 0;
  for (Seat& seat : seats_) seat.device->stop(segment_.now());
  words_.cancel();
  waits_.assign(signals_.size(), false);
  set_wake();
  for (const Seat& seat : seats_) segment_.refresh(seat.number);
}

network::State RingNetwork::state() const {
  const Time now = segment_.now();
  if (words_.has_all_arrived() && words_.last_call() && attendance_.is_complete()) {
    const network::AcceptanceRules rules = acceptance();
    const Duration silence =
        std::max(rules.silence_cycles * longest_rotation(description_), rules.least_silence);
    const bool is_called = now - *words_.last_call() <= silence;
    return is_called && attendance_.is_lasting(now, bring_up_limit()) ? network::State::exchanging
                                                                      : network::State::stopped;
  }
  return !is_on_ || now - started_ > bring_up_limit() ? network::State::stopped : network::State::coming_up;
}

std::string RingNetwork::complaint() const {
  const std::string absent = attendance_.complaint();
  return absent.empty() ? attendance_.complaint_about_gone(segment_.now(), bring_up_limit()) : absent;
}

// Each station waits for a window, and the longest contest in it.
Duration RingNetwork::bring_up_limit() const {
  const auto stations = static_cast<std::int64_t>(seats_.size());
  const Duration contest = contest_passes(description_.rules) * slots(description_.rules, 6);
  return acceptance().least_bring_up +
         stations * (kTokensUntilWindow * longest_rotation(description_) + 2 * contest);
}

// Who has fallen out of the ring comes back through a window.
network::RecoveryLimit RingNetwork::recovery_limit() const {
  const std::int64_t rotations =
      acceptance().recovery_cycles + kTokensUntilWindow * static_cast<std::int64_t>(seats_.size());
  const Duration contest = contest_passes(description_.rules) * slots(description_.rules, 8);
  return {static_cast<std::uint64_t>(rotations) * words_.size(),
          rotations * longest_rotation(description_) + static_cast<std::int64_t>(seats_.size()) * contest,
          "recovery_cycles, and 20 tokens of each station, after which it opens a window",
          judge::Standing::own};
}

std::vector<measure::Condition> RingNetwork::conditions() const {
  return {{"stations", fmt::format("{}", seats_.size())},
          {"slot time", kernel::describe(slots(description_.rules, 1))},
          {"a word is sampled", "when the one before it must have arrived"}};
}

// What a check of 32 bits cannot see has no closed form here: it is counted over 2^32 words of the dual code.
std::vector<network::ProtectedFrame> RingNetwork::protected_frames() const {
  return {};
}

void RingNetwork::set_source(std::size_t signal, std::uint16_t word) {
  words_.set_word(signal, word);
  if (is_on_) give_next(signal, segment_.now());
}

void RingNetwork::set_source_function(std::size_t signal, std::function<std::uint16_t(Time)> word) {
  words_.set_function(signal, std::move(word));
}

std::uint16_t RingNetwork::image(std::size_t) const {
  FIELDPROOF_CHECK(false, "no signal of a ring has an image");
  return 0;
}

std::vector<network::CopiedPath> RingNetwork::paths() const {
  std::vector<network::CopiedPath> paths;
  for (std::size_t n = 0; n < description_.data.size(); ++n) {
    const RingData& data = description_.data[n];
    paths.push_back({.name = fmt::format("station {} to station {}", data.from, data.to),
                     .from = static_cast<int>(data.from),
                     .to = static_cast<int>(data.to),
                     .source = n,
                     .sink = n,
                     .is_image_of_its_own = true,
                     .why_open = "response windows make a round of the token longer now and then"});
  }
  return paths;
}

void RingNetwork::end() {
  for (const Seat& seat : seats_) seat.device->end();
}

// ---- the lower tester and the applications ----

RingNetwork::Seat& RingNetwork::seat_of(Address address) {
  return *std::ranges::find(seats_, address, &Seat::address);
}

// One word at a time: what waits for a token goes first.
void RingNetwork::give(std::size_t signal, Time now) {
  if (waits_[signal]) return;
  const std::uint16_t word = words_.sample(signal, now);
  const RingData& data = description_.data[signal];
  waits_[signal] = seat_of(data.from).device->submit(
      {.priority = kWordPriority,
       .destination = data.to,
       .data = {static_cast<std::uint8_t>(signal), static_cast<std::uint8_t>(word >> 8),
                static_cast<std::uint8_t>(word & 0xFF)}},
      now);
}

void RingNetwork::on_wave(const line::Waveform& wave) {
  for (const Reception& one : tester_.read(wave)) {
    const auto frame =
        one.kind == ReceptionKind::frame ? frame_of(one.octets, description_.rules) : std::nullopt;
    if (!frame) continue;
    if (frame->kind == FrameKind::token) on_token(frame->destination, wave.start, wave.end());
    const bool is_word =
        frame->kind == FrameKind::data && frame->data.size() == kWordOctets && frame->data[0] < words_.size();
    if (!is_word) continue;
    words_.on_sent(frame->data[0]);
    waits_[frame->data[0]] = false;
  }
}

void RingNetwork::on_token(Address destination, Time begin, Time end) {
  // A token that is repeated begins no other round.
  const bool is_next = std::exchange(last_token_, destination) != destination;
  if (is_next && destination == description_.stations.front()) words_.begin_cycle(0, begin);
  const Duration of_word = frame_time(description_.rules, kWordOctets) + slots(description_.rules, 1);
  std::int64_t words = 0;
  for (std::size_t n = 0; n < words_.size(); ++n) {
    if (description_.data[n].from != destination) continue;
    const Time closes_at = end + ++words * of_word;
    if (words_.is_called(n) && !words_.is_sent(n)) {
      words_.call_again(n, begin, closes_at);
      continue;
    }
    if (words_.is_called(n)) {
      words_.close(n, begin);
      give_next(n, begin);
    }
    words_.call(n, begin, closes_at);
  }
  set_wake();
}

void RingNetwork::on_data(Address at, const Frame& frame, Time when) {
  if (frame.data.size() != kWordOctets || frame.data[0] >= words_.size()) return;
  const std::size_t signal = frame.data[0];
  const RingData& data = description_.data[signal];
  if (data.to != at || data.from != frame.source) return;
  words_.on_got(signal, static_cast<std::uint16_t>(frame.data[1] << 8 | frame.data[2]), when);
}

void RingNetwork::give_next(std::size_t signal, Time now) {
  give(signal, now);
  segment_.refresh(seat_of(description_.data[signal].from).number);
}

void RingNetwork::set_wake() {
  wakes_at_ = words_.next_close();
  if (has_tester_) segment_.refresh(tester_number_);
}

void RingNetwork::on_time(Time now) {
  words_.close_due(now, [&](std::size_t signal) { give_next(signal, now); });
  set_wake();
}

}  // namespace fieldproof::token_bus
