#include "protocols/token_bus/ring_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/kernel/check.hpp"
#include "protocols/token_bus/dissector.hpp"
#include "protocols/token_bus/token_station.hpp"

namespace fieldproof::token_bus {
namespace {

using kernel::Duration;
using kernel::Time;

// A window opens after so many tokens of a station at most.
constexpr std::int64_t kTokensUntilWindow = 20;
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
      channel_reader_(description.rules),
      tester_(description.rules) {
  FIELDPROOF_CHECK(!violation_of(description_), "a ring that runs is one within its limits");
  for (unsigned n = 0; n < description_.channels; ++n) {
    const std::string name =
        description_.channels == 1 ? "line" : fmt::format("line {}", text_of(kChannels[n]));
    lines_.emplace_back(segment_, description_, kChannels[n], name, random_);
  }
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
  list_cycles();
}

void RingNetwork::list_cycles() {
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
  for (std::size_t n = 0; n < seats_.size(); ++n) {
    if (!seats_[n].turnaround) continue;
    seats_[n].turnaround_kind = cycles_.size();
    cycles_.push_back(
        {.name = fmt::format("turnaround time of station@{}", n + 1),
         .theory = slots(description_.rules, 1),
         .form = "from the end of a token to it until it drives; at most a slot time, the ways included",
         .is_bound = true,
         .is_delay = true});
  }
  if (description_.cuts.empty()) return;
  cut_kind_ = cycles_.size();
  cycles_.push_back({.name = "round with a cut",
                     .theory = longest_disturbed_rotation(description_),
                     .form = "a round, and a token or a request that is repeated",
                     .is_bound = true,
                     .is_delay = true});
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
  connect(seat, name, position, is_under_test);
}

segment::MediumPort& RingNetwork::attach(const std::string& name, std::size_t station, Channel channel,
                                         std::size_t position) {
  const auto port = static_cast<segment::PortIndex>(channel);
  segment::MediumPort& place = lines_[port].attach(name, station, port, position - 1);
  place.sense_activity();
  // Levels are half bits.
  places_.push_back({.name = place.name(),
                     .receiver = &place,
                     .trace_channel = place.trace_channel(),
                     .level_rate = 2 * description_.rules.phy_bit_rate,
                     .sampling = line::kMidBit});
  return place;
}

void RingNetwork::connect(Seat& seat, const std::string& name, std::size_t position, bool is_under_test) {
  segment::MediumPort* first = nullptr;  // what is driven is the same on both
  if (description_.channels == 1) {
    first = &attach(name + "/in", seat.number, Channel::a, position);
    seat.device->wire(*first, *seat.user);
  } else {
    const auto on_event = [this, &seat](const ChannelEvent& event, Time) {
      if (event.kind != ChannelEventKind::clean && came_up_at_)
        ++seat.faults[static_cast<std::size_t>(event.channel)];
    };
    seat.channels =
        std::make_unique<ChannelPair>(segment_, seat.number, description_.rules, channel_reader_, on_event);
    const std::size_t number = segment_.attach(*seat.channels, name + " channels");
    first = &attach(name + "/A", number, Channel::a, position);
    seat.channels->wire(*first, attach(name + "/B", number, Channel::b, position));
    seat.device->wire(*seat.channels, *seat.user);
  }
  first->tap_driven(*this);
  if (!is_under_test) return;
  first->tap_driven(attendance_.expect(name));
  seat.turnaround.emplace(network::AnswerBegin::first_level, [this, &seat](Time asked, Time answered) {
    words_.end_delay(seat.turnaround_kind, asked, answered);
  });
  first->tap_driven(*seat.turnaround);
}

void RingNetwork::start() {
  if (!std::exchange(has_tester_, true)) tester_number_ = segment_.attach(*this, "tester");
  if (is_on_) stop();
  started_ = segment_.now();
  is_on_ = true;
  for (Seat& seat : seats_) {
    if (seat.channels) seat.channels->reset();
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
  begin_cuts(std::nullopt);
  for (Seat& seat : seats_) {
    seat.device->stop(segment_.now());
    seat.has_had_token = false;
    seat.asks.reset();
    if (seat.turnaround) seat.turnaround->forget();
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
  if (description_.channels == 2) {
    conditions.push_back({"channels", fmt::format("2, cut {} times; their selection is this project's choice",
                                                  description_.cuts.size())});
  }
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
std::shared_ptr<const trace::Dissector> RingNetwork::dissector() const {
  return std::make_shared<BusDissector>(description_.rules);
}

std::vector<network::ProtectedFrame> RingNetwork::protected_frames() const {
  return {};
}

std::vector<measure::Count> RingNetwork::remarks() const {
  std::vector<measure::Count> remarks{{"tokens that were passed again", repeated_tokens_, 0},
                                      {"claims of the token", claims_, 0}};
  for (std::size_t n = 0; n < flows_.size(); ++n) {
    if (flows_[n].refused() > 0)
      remarks.push_back({fmt::format("requests that the ring has no room for, {} ({})", signals_[n].name,
                                     text_of(flows_[n].data().service)),
                         flows_[n].refused(), flows_[n].requests()});
  }
  if (description_.channels == 1) return remarks;
  for (const Channel channel : kChannels) {
    std::uint64_t faults = 0;
    std::uint64_t finders = 0;
    std::uint64_t left = 0;
    for (const Seat& seat : seats_) {
      const std::uint64_t its = seat.faults[static_cast<std::size_t>(channel)];
      faults += its;
      finders += its > 0 ? 1U : 0U;
      left += seat.channels->has_fault(channel) ? 1U : 0U;
    }
    remarks.push_back({fmt::format("faults of channel {} that were reported", text_of(channel)), faults, 0});
    remarks.push_back({fmt::format("stations that reported faults of channel {}", text_of(channel)), finders,
                       seats_.size()});
    remarks.push_back({fmt::format("stations for which channel {} has a fault still", text_of(channel)), left,
                       seats_.size()});
  }
  return remarks;
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

}  // namespace fieldproof::token_bus
