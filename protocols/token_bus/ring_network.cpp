#include "protocols/token_bus/ring_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/kernel/check.hpp"
#include "protocols/token_bus/token_station.hpp"

namespace fieldproof::token_bus {
namespace {

using kernel::Duration;
using kernel::Time;

// A window opens after so many tokens of a station at most.
constexpr std::int64_t kTokensUntilWindow = 20;
// Rounds of the token after which a datum that was not sent is missing.
constexpr std::int64_t kRoundsWaited = 2;
// A round that is longer for another reason than data: a contest, a lost token.
constexpr std::size_t kRotation = 0;

// What the application of a station answers confirmed data with.
Octets response_of(Address address) {
  return {0xFF, static_cast<std::uint8_t>(address >> 8), static_cast<std::uint8_t>(address)};
}

std::string unbounded_because(RingService service) {
  return service == RingService::urgent
             ? "no bound: data come oftener than each other round, or outlast the hold time"
             : "no bound: data come oftener than each other round, or a round may outlast the target time";
}

}  // namespace

// ---- the running ring ----

RingNetwork::RingNetwork(const RingDescription& description, std::uint64_t seed, const RingStations& stations)
    : description_(description),
      bounds_(bounds_of(description)),
      random_(seed),
      line_(segment_, description_, "line", random_),
      tester_(description.rules) {
  FIELDPROOF_CHECK(!violation_of(description_), "a ring that runs is one within its limits");
  // A word that waits for a token outlives each one that is lost: it is late, not wrong.
  constexpr unsigned kMostWaiting = 16;
  for (const RingData& data : description_.data) {
    flows_.emplace_back(data, static_cast<std::uint8_t>(signals_.size()),
                        random_.split("flows").split(signals_.size()));
    signals_.push_back({.name = fmt::format("word of station {} at station {}", data.from, data.to),
                        .admissible_words = kMostWaiting});
    words_.add_signal();
    deliveries_.add_flow();
  }
  for (std::size_t n = 0; n < description_.stations.size(); ++n)
    add(description_.stations[n], n + 1, stations);
  cycles_.push_back({.name = "token rotation",
                     .theory = bounds_.rotation,
                     .form = "all data or what the timers leave, and a response window of each station",
                     .is_bound = true});
  for (const RingService service : kRingServices) {
    if (std::ranges::find(description_.data, service, &RingData::service) == description_.data.end())
      continue;
    delay_kinds_[static_cast<std::size_t>(service)] = cycles_.size();
    const auto bound = bounds_.access[static_cast<std::size_t>(service)];
    cycles_.push_back(
        {.name = fmt::format("access delay, {}", text_of(service)),
         .theory = bound.value_or(Duration{}),
         .form = bound ? "a round, and the data of this class of the station" : unbounded_because(service),
         .is_bound = true,
         .is_delay = true});
  }
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
  segment::MediumPort& place = line_.attach(name + "/in", seat.number, 0, position - 1);
  place.sense_activity();
  place.tap_driven(*this);
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
  for (Seat& seat : seats_) {
    seat.device->start(started_);
    const bool confirms = std::ranges::any_of(description_.data, [&](const RingData& data) {
      return data.to == seat.address && data.service == RingService::confirmed;
    });
    if (confirms) seat.device->set_response(response_of(seat.address), started_);
  }
  attendance_.begin();
  words_.begin();
  set_wake();
  for (const Seat& seat : seats_) segment_.refresh(seat.number);
}

void RingNetwork::stop() {
  is_on_ = false;
  last_token_ = 0;
  last_token_at_.reset();
  for (Seat& seat : seats_) {
    seat.device->stop(segment_.now());
    seat.has_had_token = false;
    seat.asks.reset();
  }
  words_.cancel();
  for (RingFlow& flow : flows_) flow.stop();
  set_wake();
  for (const Seat& seat : seats_) segment_.refresh(seat.number);
}

network::State RingNetwork::state() const {
  const Time now = segment_.now();
  if (words_.has_all_arrived() && last_token_at_ && attendance_.is_complete()) {
    const network::AcceptanceRules rules = acceptance();
    const Duration silence = std::max(rules.silence_cycles * bounds_.rotation, rules.least_silence);
    const bool is_alive = now - *last_token_at_ <= silence;
    return is_alive && attendance_.is_lasting(now, bring_up_limit()) ? network::State::exchanging
                                                                     : network::State::stopped;
  }
  return !is_on_ || now - started_ > bring_up_limit() ? network::State::stopped : network::State::coming_up;
}

std::string RingNetwork::complaint() const {
  std::string complaint = attendance_.complaint();
  if (complaint.empty()) complaint = attendance_.complaint_about_gone(segment_.now(), bring_up_limit());
  for (std::size_t n = 0; n < signals_.size() && complaint.empty(); ++n) {
    if (!words_.has_arrived(n))
      complaint =
          fmt::format("no {} ({}) since power-up", signals_[n].name, text_of(flows_[n].data().service));
  }
  return complaint;
}

Duration RingNetwork::longest_period() const {
  Duration longest{};
  for (const RingData& data : description_.data) longest = std::max(longest, data.mean_gap());
  return longest;
}

// Each station waits for a window, and the longest contest in it; then each datum comes. Gaps at random are
// longer than this once in 10^8.
Duration RingNetwork::bring_up_limit() const {
  const auto stations = static_cast<std::int64_t>(seats_.size());
  const Duration contest = contest_passes(description_.rules) * slots(description_.rules, 6);
  constexpr std::int64_t kMeanGaps = 20;
  return acceptance().least_bring_up + kMeanGaps * longest_period() +
         stations * (kTokensUntilWindow * bounds_.rotation + 2 * contest);
}

// Who has fallen out of the ring comes back through a window; then its data are due.
network::RecoveryLimit RingNetwork::recovery_limit() const {
  const std::int64_t rotations =
      acceptance().recovery_cycles + kTokensUntilWindow * static_cast<std::int64_t>(seats_.size());
  const Duration contest = contest_passes(description_.rules) * slots(description_.rules, 8);
  constexpr std::int64_t kMeanGaps = 2;
  const Duration period = kMeanGaps * longest_period();
  std::int64_t exchanges = rotations * static_cast<std::int64_t>(words_.size());
  for (const RingData& data : description_.data)
    exchanges += period / std::max(data.mean_gap(), least_rotation(description_));
  return {static_cast<std::uint64_t>(exchanges),
          period + rotations * bounds_.rotation + static_cast<std::int64_t>(seats_.size()) * contest,
          "recovery_cycles, and 20 tokens of each station, after which it opens a window",
          judge::Standing::own};
}

std::vector<measure::Condition> RingNetwork::conditions() const {
  std::vector<measure::Condition> conditions{{"stations", fmt::format("{}", seats_.size())},
                                             {"slot time", kernel::describe(slots(description_.rules, 1))},
                                             {"a word is sampled", "when its datum is given to the MAC"}};
  if (description_.cable_m > 0) {
    conditions.push_back(
        {"path from end to end",
         fmt::format("{}, {} repeaters, this project's choice of delays",
                     kernel::describe(path_delay(description_)), description_.repeaters_m.size())});
  }
  const auto used = [&](RingService service) { return delay_kinds_[static_cast<std::size_t>(service)] != 0; };
  for (const RingService service : kRingServices) {
    if (!used(service)) continue;
    conditions.push_back({fmt::format("{} data", text_of(service)),
                          fmt::format("class {}, this project's choice", priority_of(service))});
  }
  return conditions;
}

std::vector<measure::Count> RingNetwork::delivery_faults() const {
  const auto of = [&](Delivery delivery) { return deliveries_by_kind_[static_cast<std::size_t>(delivery)]; };
  return {{"data delivered twice", of(Delivery::twice)},
          {"data out of order", of(Delivery::out_of_order)},
          {"data that nobody had sent so", of(Delivery::wrong)}};
}

// What a check of 32 bits cannot see has no closed form here: it is counted over 2^32 words of the dual code.
std::vector<network::ProtectedFrame> RingNetwork::protected_frames() const {
  return {};
}

void RingNetwork::set_source(std::size_t signal, std::uint16_t word) {
  words_.set_word(signal, word);
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

// One datum at a time: what waits for a token goes first.
void RingNetwork::give(std::size_t signal, Time now) {
  RingFlow& flow = flows_[signal];
  if (!flow.may_give() || words_.is_called(signal)) return;
  const auto datum = flow.next_datum(words_.sample(signal, now));
  const RingData& data = flow.data();
  Seat& seat = seat_of(data.from);
  const bool is_taken = seat.device->submit({.action = action_of(data.service),
                                             .priority = priority_of(data.service),
                                             .destination = data.to,
                                             .data = octets_of(*datum, data.octets)},
                                            now);
  segment_.refresh(seat.number);
  if (!is_taken) return flow.on_done();
  deliveries_.give(*datum);
  words_.call(signal, now, now + kRoundsWaited * bounds_.rotation);
}

void RingNetwork::on_wave(const line::Waveform& wave) {
  for (const Reception& one : tester_.read(wave)) {
    const auto frame =
        one.kind == ReceptionKind::frame ? frame_of(one.octets, description_.rules) : std::nullopt;
    if (!frame) continue;
    if (frame->kind == FrameKind::token) on_token(frame->destination, wave.start);
    if (frame->kind == FrameKind::data) on_datum(*frame, wave.start, wave.end());
  }
}

void RingNetwork::on_token(Address destination, Time begin) {
  last_token_at_ = begin;
  // A token that is repeated begins no other round.
  const bool is_next = std::exchange(last_token_, destination) != destination;
  if (is_next && destination == description_.stations.front()) words_.begin_cycle(kRotation, begin);
  const auto seat = std::ranges::find(seats_, destination, &Seat::address);
  if (seat == seats_.end()) return;
  const bool is_first = !std::exchange(seat->has_had_token, true);
  for (std::size_t n = 0; n < flows_.size(); ++n) {
    RingFlow& flow = flows_[n];
    if (flow.data().from != destination) continue;
    if (is_first) flow.begin(begin);
    if (words_.is_called(n) && words_.is_sent(n) && flow.data().is_under_each_token()) close(n, begin);
    if (words_.is_called(n)) {
      // What is due under each token has missed one.
      const bool is_retry = !is_next || flow.data().is_under_each_token();
      if (is_retry && !words_.is_sent(n)) words_.call_again(n, begin);
    } else if (flow.given()) {
      words_.call(n, begin, begin + kRoundsWaited * bounds_.rotation);
    } else if (flow.data().is_under_each_token()) {
      flow.request(begin);
      give(n, begin);
    }
  }
  set_wake();
}

void RingNetwork::on_datum(const Frame& frame, Time begin, Time end) {
  const auto datum = datum_of(frame.data);
  if (!datum || datum->flow >= flows_.size()) return;
  const std::size_t signal = datum->flow;
  RingFlow& flow = flows_[signal];
  const RingData& data = flow.data();
  if (frame.source != data.from || !flow.given() || flow.given()->datum != *datum) return;
  if (const auto requested = flow.on_sent(*datum)) {
    words_.end_delay(delay_kinds_[static_cast<std::size_t>(data.service)], *requested, end);
  } else if (words_.is_called(signal)) {
    words_.call_again(signal, begin);
  }
  Duration due = slots(description_.rules, 1);
  if (data.service == RingService::confirmed) {
    seat_of(data.from).asks = signal;
    due += slots(description_.rules, description_.rules.response_wait_slots) +
           frame_time(description_.rules, kResponseOctets);
  } else {
    flow.on_done();
  }
  words_.on_sent(signal, end + due);
  set_wake();
}

void RingNetwork::on_data(Address at, const Frame& frame, Time when) {
  if (frame.action == Action::response) return on_response(seat_of(at), frame, when);
  const auto datum = datum_of(frame.data);
  if (!datum || datum->flow >= flows_.size()) return count(Delivery::wrong);
  const RingData& data = flows_[datum->flow].data();
  const bool is_its = data.to == at && data.from == frame.source && data.octets == frame.data.size();
  const Delivery delivery = is_its ? deliveries_.get(*datum) : Delivery::wrong;
  const bool is_repetition = data.service == RingService::confirmed && delivery == Delivery::twice;
  if (is_repetition) return;
  count(delivery);
  if (delivery == Delivery::first) words_.on_got(datum->flow, datum->word, when);
}

void RingNetwork::on_response(Seat& seat, const Frame& frame, Time when) {
  if (!seat.asks || flows_[*seat.asks].data().to != frame.source) return;
  if (frame.data != response_of(frame.source)) return count(Delivery::wrong);
  close(*std::exchange(seat.asks, std::nullopt), when);
}

void RingNetwork::on_event(Address at, const Event& event, Time when) {
  Seat& seat = seat_of(at);
  const bool is_about_it =
      event.kind == EventKind::response_missing && seat.asks && flows_[*seat.asks].data().to == event.address;
  if (is_about_it) close(*std::exchange(seat.asks, std::nullopt), when);
}

// Nothing more comes of what was sent; the next one may go.
void RingNetwork::close(std::size_t signal, Time now) {
  if (words_.is_called(signal)) words_.close(signal, now);
  after_close(signal, now);
}

void RingNetwork::after_close(std::size_t signal, Time now) {
  RingFlow& flow = flows_[signal];
  if (flow.given() && flow.given()->is_sent) flow.on_done();
  give(signal, now);
  set_wake();
}

void RingNetwork::set_wake() {
  wakes_at_ = words_.next_close();
  for (const RingFlow& flow : flows_) wakes_at_ = std::min(wakes_at_, flow.next_request());
  if (has_tester_) segment_.refresh(tester_number_);
}

void RingNetwork::on_time(Time now) {
  words_.close_due(now, [&](std::size_t signal) { after_close(signal, now); });
  for (std::size_t n = 0; n < flows_.size(); ++n) {
    flows_[n].take_due(now);
    give(n, now);
  }
  set_wake();
}

}  // namespace fieldproof::token_bus
