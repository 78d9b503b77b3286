#include "protocols/token_bus/ring_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/config/name.hpp"
#include "harness/field/json_reader.hpp"
#include "protocols/token_bus/rules_table.hpp"

namespace fieldproof::token_bus {
namespace {

constexpr unsigned kMostRingStations = 64;
constexpr std::size_t kMostFlows = 256;
constexpr std::size_t kMostCuts = 64;
constexpr double kLongestCable = 100'000;  // m: more is a slip of the pen
constexpr kernel::Duration kShortestPeriod = 100 * kernel::kMicrosecond;
constexpr kernel::Duration kLongestPeriod = 100 * kernel::kSecond;

RingData read_ring_data(const config::Value& value) {
  return config::read_object(value, [](config::ObjectReader& object) {
    RingData data;
    data.from = object.required("from").as_integer<Address>();
    data.to = object.required("to").as_integer<Address>();
    if (const auto service = object.optional("service")) {
      data.service = service->as_choice<RingService>({{"urgent", RingService::urgent},
                                                      {"periodic", RingService::periodic},
                                                      {"confirmed", RingService::confirmed},
                                                      {"bulk", RingService::bulk}});
    }
    if (const auto every = object.optional("every"))
      data.every = every->as_duration(kShortestPeriod, kLongestPeriod);
    if (const auto load = object.optional("load")) data.load = load->as_bit_rate();
    if (const auto octets = object.optional("octets")) data.octets = octets->as_integer<std::size_t>();
    return data;
  });
}

void read_cable(config::ObjectReader& object, RingDescription& ring) {
  if (const auto cable = object.optional("cable")) ring.cable_m = cable->as_length_m(0, kLongestCable);
  const auto repeaters = object.optional("repeaters");
  if (!repeaters) return;
  for (const config::Value& one : repeaters->as_array(1, ring.cable.most_repeaters))
    ring.repeaters_m.push_back(one.as_length_m(0, kLongestCable));
  ring.rules.most_octets = ring.cable.most_octets_with_repeaters;
}

RingCut read_cut(const config::Value& value) {
  return config::read_object(value, [](config::ObjectReader& object) {
    RingCut cut;
    cut.channel = object.required("channel").as_choice<Channel>({{"A", Channel::a}, {"B", Channel::b}});
    cut.at = object.required("at").as_duration({}, kLongestPeriod);
    cut.lasts = object.required("lasts").as_duration(kernel::kPicosecond, kLongestPeriod);
    cut.after = object.required("after").as_integer<Address>();
    return cut;
  });
}

void read_channels(config::ObjectReader& object, RingDescription& ring) {
  if (const auto channels = object.optional("channels")) ring.channels = channels->as_integer<unsigned>(1, 2);
  const auto cuts = object.optional("cuts");
  if (!cuts) return;
  for (const config::Value& one : cuts->as_array(1, kMostCuts)) ring.cuts.push_back(read_cut(one));
}

bool is_in(const std::vector<Address>& stations, Address address) {
  return std::ranges::find(stations, address) != stations.end();
}

std::optional<config::Violation> violation_of_stations(const RingDescription& ring) {
  for (std::size_t n = 0; n < ring.stations.size(); ++n) {
    const Address address = ring.stations[n];
    const std::string at = fmt::format("/stations/{}", n);
    if (address == 0 || is_group(address) || address > broadcast(ring.rules))
      return {
          {at, fmt::format("station {}: an address is even, from 2 to 65534, because an odd one is a group's",
                           address)}};
    if (std::ranges::find(ring.stations, address) - ring.stations.begin() < static_cast<std::ptrdiff_t>(n))
      return {{at, fmt::format("station {} is there twice; each has its own address", address)}};
  }
  return std::nullopt;
}

// A frame begins a gap after the token, and only while its class has time left.
std::optional<std::string> why_it_never_goes(const Rules& rules, const RingData& data) {
  if (data.service == RingService::urgent) {
    if (rules.high_priority_hold_octets > rules.response_gap_octets) return std::nullopt;
    return fmt::format("high_priority_hold_octets is {}, and a frame begins {} octets after the token",
                       rules.high_priority_hold_octets, rules.response_gap_octets);
  }
  const std::size_t place = static_cast<std::size_t>(data.service) - 1;
  if (rules.target_rotation_octets.at(place) > rules.response_gap_octets) return std::nullopt;
  return fmt::format("target_rotation_octets/{} is {}, so {} data are never served", place,
                     rules.target_rotation_octets[place], text_of(data.service));
}

std::optional<config::Violation> violation_of_data(const RingDescription& ring, std::size_t n) {
  const RingData& data = ring.data[n];
  const std::string at = fmt::format("/data/{}", n);
  const std::string who = fmt::format("data from {} to {}", data.from, data.to);
  const bool is_from_nobody = !is_in(ring.stations, data.from);
  if (is_from_nobody || !is_in(ring.stations, data.to) || data.from == data.to)
    return {
        {at + (is_from_nobody ? "/from" : "/to"), who + ": write two different addresses of \"stations\""}};
  if (data.every != kernel::Duration{} && data.load != 0)
    return {{at + "/load", who + ": they have a period or a load, not both"}};
  if (const auto why = why_it_never_goes(ring.rules, data))
    return {{at, fmt::format("{} never go: {}", who, *why)}};
  if (data.octets < kLeastDatum || data.octets > most_data(ring.rules))
    return {{at + "/octets",
             fmt::format("{}: {} octets, and a frame carries {} to {}{}", who, data.octets, kLeastDatum,
                         most_data(ring.rules),
                         ring.repeaters_m.empty() ? "" : ", because a repeater cuts what is longer")}};
  return std::nullopt;
}

std::optional<config::Violation> violation_of_cuts(const RingDescription& ring) {
  if (!ring.cuts.empty() && ring.channels != 2)
    return {{"/channels", "a ring with \"cuts\" has \"channels\": 2"}};
  kernel::Duration repaired{};
  for (std::size_t n = 0; n < ring.cuts.size(); ++n) {
    const RingCut& cut = ring.cuts[n];
    if (!is_in(ring.stations, cut.after) || cut.after == ring.stations.back())
      return {
          {fmt::format("/cuts/{}/after", n),
           fmt::format("a cut after station {}: write one of \"stations\" that is not the last", cut.after)}};
    if (cut.at < repaired)
      return {{fmt::format("/cuts/{}/at", n),
               fmt::format("a cut at {}: the one before it is repaired at {}; cuts come one after the other",
                           kernel::describe(cut.at), kernel::describe(repaired))}};
    repaired = cut.at + cut.lasts;
  }
  return std::nullopt;
}

std::optional<config::Violation> violation_of_cable(const RingDescription& ring) {
  double begin = 0;
  std::vector<double> ends = ring.repeaters_m;
  ends.push_back(ring.cable_m);
  for (std::size_t n = 0; n < ends.size(); ++n) {
    const double end = ends[n];
    if (end < begin || (end == begin && ends.size() > 1))
      return {{fmt::format("/repeaters/{}", n == 0 ? 0 : n - 1),
               fmt::format("a repeater at {:g} m: they stand in the order of the cable, which ends at {:g} m",
                           begin, ring.cable_m)}};
    if (end - begin > ring.cable.longest_segment_m)
      return {{n + 1 < ends.size() ? fmt::format("/repeaters/{}", n) : "/cable",
               fmt::format("a segment of {:g} m: {} m is the longest; put a repeater into it", end - begin,
                           ring.cable.longest_segment_m)}};
    begin = end;
  }
  if (ring.rules.slot_time_octets < needed_slot_octets(ring))
    return {{"/slot_time_octets",
             fmt::format("a slot time of {} octets: a path of {} with {} repeater{}{} needs slot_time_octets "
                         "of {} at least, "
                         "twice the path and the {} of a station",
                         ring.rules.slot_time_octets, kernel::describe(path_delay(ring)),
                         ring.repeaters_m.size(), ring.repeaters_m.size() == 1 ? "" : "s",
                         ring.channels == 2 ? " and a selection of channels" : "", needed_slot_octets(ring),
                         kernel::describe(ring.cable.station_delay))}};
  return std::nullopt;
}

}  // namespace

std::string_view text_of(RingService service) {
  constexpr std::array<std::string_view, kRingServices.size()> kTexts{"urgent", "periodic", "confirmed",
                                                                      "bulk"};
  return kTexts.at(static_cast<std::size_t>(service));
}

kernel::Duration RingData::mean_gap() const {
  return load == 0 ? every : kernel::levels_duration(static_cast<std::int64_t>(8 * octets), load);
}

double position_m(const RingDescription& ring, std::size_t station) {
  if (ring.stations.size() < 2) return 0;
  return ring.cable_m * static_cast<double>(station) / static_cast<double>(ring.stations.size() - 1);
}

kernel::Duration cable_delay(const RingDescription& ring, double length_m) {
  return kernel::Duration{std::llround(length_m * static_cast<double>(ring.cable.cable_delay_ps_per_m))};
}

std::size_t stations_before(const RingDescription& ring, const RingCut& cut) {
  return static_cast<std::size_t>(std::ranges::find(ring.stations, cut.after) - ring.stations.begin()) + 1;
}

kernel::Duration selection_delay(const RingDescription& ring) {
  return ring.channels == 1 ? kernel::Duration{} : mac_symbols(ring.rules, ChannelRules{}.skew_symbols);
}

kernel::Duration path_delay(const RingDescription& ring) {
  const auto bits = static_cast<std::int64_t>(ring.repeaters_m.size() * ring.cable.repeater_delay_bits);
  return cable_delay(ring, ring.cable_m) + kernel::levels_duration(bits, ring.rules.phy_bit_rate) +
         selection_delay(ring);
}

unsigned needed_slot_octets(const RingDescription& ring) {
  const kernel::Duration symbol = mac_symbols(ring.rules, 1);
  const kernel::Duration all = 2 * path_delay(ring) + 2 * ring.cable.station_delay + symbol;
  const kernel::Duration octet = 8 * symbol;
  return static_cast<unsigned>((all + octet - kernel::kPicosecond) / octet);
}

RingDescription RingDescription::built_in(unsigned stations) {
  RingDescription ring;
  ring.name = fmt::format("ring of {} stations", stations);
  for (unsigned n = 0; n < stations; ++n) ring.stations.push_back(2 * (n + 1));
  for (unsigned n = 0; n < stations; ++n)
    ring.data.push_back({.from = ring.stations[n], .to = ring.stations[(n + 1) % stations]});
  return ring;
}

RingDescription RingDescription::read(const config::Value& root) {
  const RingDescription ring = config::read_object(root, [](config::ObjectReader& object) {
    RingDescription read;
    object.optional("$schema");
    read.name = config::read_name(object.required("name"));
    for (const config::Value& one : object.required("stations").as_array(2, kMostRingStations))
      read.stations.push_back(one.as_integer<Address>());
    for (const config::Value& one : object.required("data").as_array(1, kMostFlows))
      read.data.push_back(read_ring_data(one));
    read_cable(object, read);
    read_channels(object, read);
    field::read_members(object, kRulesInARingFile, read.rules);
    return read;
  });
  if (const auto violation = violation_of(ring)) config::fail(root, *violation);
  return ring;
}

RingDescription RingDescription::load(const std::filesystem::path& path) {
  const config::Document document = config::Document::load(path);
  return read(document.root());
}

std::optional<config::Violation> violation_of(const RingDescription& ring) {
  if (auto sentence = impossible(ring.rules)) return {{"", std::move(*sentence)}};
  if (auto violation = violation_of_stations(ring)) return violation;
  if (auto violation = violation_of_cuts(ring)) return violation;
  if (auto violation = violation_of_cable(ring)) return violation;
  for (std::size_t n = 0; n < ring.data.size(); ++n) {
    if (auto violation = violation_of_data(ring, n)) return violation;
  }
  return std::nullopt;
}

}  // namespace fieldproof::token_bus
