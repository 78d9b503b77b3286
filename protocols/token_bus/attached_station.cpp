#include "protocols/token_bus/attached_station.hpp"

#include <fmt/format.h>

#include <utility>

#include "harness/iut/misbehaviour.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::token_bus {
namespace {

constexpr unsigned kUserAddressOctets = 6;
constexpr std::size_t kSubmitHead = 3 + kUserAddressOctets;
constexpr std::size_t kMostUserOctets = 8'192;

}  // namespace

// ---- an implementation outside ----

AttachedStation::AttachedStation(iut::Attachment attachment, const StationConfiguration& configuration,
                                 const std::string& case_id, std::uint64_t seed)
    : rules_(configuration.rules), attached_(std::move(attachment)), line_(attached_) {
  if (attached_.unit_kind() != iut::UnitKind::levels) {
    throw kernel::Error(kernel::ErrorKind::implementation,
                        "a station of the token bus receives and sends levels; this implementation announces "
                        "another unit");
  }
  line_.expect_activity();
  attached_.begin({case_id, seed, station_settings(configuration)}, *this);
}

void AttachedStation::wire(segment::Port& line, StationUser& user) {
  line_.wire(line);
  user_ = &user;
}

bool AttachedStation::start(kernel::Time now) {
  counters_ = {};
  return line_.start(now);
}

bool AttachedStation::submit(const DataRequest& request, kernel::Time now) {
  Octets octets{static_cast<std::uint8_t>(StationAsk::submit), static_cast<std::uint8_t>(request.action),
                static_cast<std::uint8_t>(request.priority)};
  iut::put_number(octets, request.destination, kUserAddressOctets);
  octets.insert(octets.end(), request.data.begin(), request.data.end());
  return line_.ask(octets, now);
}

void AttachedStation::set_in_ring_desired(bool is_desired, kernel::Time now) {
  line_.ask({static_cast<std::uint8_t>(StationAsk::in_ring_desired),
             is_desired ? std::uint8_t{1} : std::uint8_t{0}},
            now);
}

void AttachedStation::set_response(const Octets& data, kernel::Time now) {
  Octets octets{static_cast<std::uint8_t>(StationAsk::response)};
  octets.insert(octets.end(), data.begin(), data.end());
  line_.ask(octets, now);
}

void AttachedStation::send(unsigned port, kernel::Time start, std::span<const std::uint16_t> characters) {
  if (port != iut::kUserPort) iut::refuse_impossible("drives characters, having announced levels");
  attached_.expect_in_order(start, "reports something to its user");
  const Octets octets = iut::UserLine::reported_octets(characters, kMostUserOctets);
  const auto frame = octets.empty() ? std::nullopt : frame_of(std::span(octets).subspan(1), rules_);
  const bool is_data = frame && (frame->kind == FrameKind::data || frame->kind == FrameKind::management_data);
  if (!is_data || octets.front() != kIndication)
    iut::refuse_impossible("reports to its user what is not 01 and a data frame");
  user_->on_data(*frame, start);
}

void AttachedStation::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  attached_.expect_in_order(when, "reports an event to its user");
  if (item == iut::kRefused) {
    line_.refuse();
  } else if (item >= kFaultyReceptions && item < kFaultyReceptions + counters_.size()) {
    counters_.at(item - kFaultyReceptions) = static_cast<std::uint32_t>(value);
  } else if (item != iut::kEvent) {
    iut::refuse_impossible(
        fmt::format("writes item {}, which a station of the token bus does not have", item));
  } else if ((value & 0xFF) >= kEventKinds || value >> 8 > broadcast(rules_)) {
    iut::refuse_impossible(fmt::format("reports {:X}h as an event; there are kinds 0 to {} about an address",
                                       value, kEventKinds - 1));
  } else {
    user_->on_event({static_cast<EventKind>(value & 0xFF), value >> 8}, when);
  }
}

std::uint64_t AttachedStation::read(iut::Item item, kernel::Time) {
  iut::refuse_impossible(fmt::format("reads item {}; a station of the token bus has none to read", item));
}

// ---- a station of ours ----

bool ServedStation::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  const StationConfiguration configuration = station_configuration_of(begin);
  rules_ = configuration.rules;
  counters_ = {};
  play(make_(configuration), bench);
  station().wire(port(iut::kLinePort), *this);
  return true;
}

void ServedStation::set_power(bool is_on, kernel::Time now) {
  act(now, [&] {
    if (!is_on) {
      station().stop(now);
    } else if (!station().start(now)) {
      refuse(now);
    }
  });
}

bool ServedStation::asked(const Octets& request, kernel::Time now) {
  const auto rest = std::span(request).subspan(1);
  switch (static_cast<StationAsk>(request[0])) {
    case StationAsk::in_ring_desired:
      if (rest.size() != 1 || rest[0] > 1) return false;
      station().set_in_ring_desired(rest[0] == 1, now);
      return true;
    case StationAsk::response:
      station().set_response(Octets(rest.begin(), rest.end()), now);
      return true;
    case StationAsk::submit:
      break;
    default:
      return false;
  }
  if (request.size() < kSubmitHead || request[1] > static_cast<std::uint8_t>(Action::response)) return false;
  const auto data = std::span(request).subspan(kSubmitHead);
  return station().submit({.action = static_cast<Action>(request[1]),
                           .priority = request[2],
                           .destination = iut::number_at(request, 3, kUserAddressOctets),
                           .data = Octets(data.begin(), data.end())},
                          now);
}

// Counters are written as soon as they change.
void ServedStation::after_call() {
  const Counters counters = station().counters();
  for (std::size_t n = 0; n < counters.size(); ++n) {
    if (counters[n] == counters_[n]) continue;
    bench().write(kFaultyReceptions + static_cast<iut::Item>(n), counters[n], now());
  }
  counters_ = counters;
}

void ServedStation::on_data(const Frame& frame, kernel::Time when) {
  Octets octets{kIndication};
  const Octets of_frame = octets_of(frame, rules_);
  octets.insert(octets.end(), of_frame.begin(), of_frame.end());
  report_to_user(octets, when);
}

}  // namespace fieldproof::token_bus
