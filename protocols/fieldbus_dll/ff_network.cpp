#include "protocols/fieldbus_dll/ff_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "protocols/fieldbus_dll/ff_las.hpp"
#include "protocols/fieldbus_dll/link_dissector.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr std::uint8_t kFirstSelector = 0x20;
constexpr std::size_t kWordOctets = 2;

// Addresses beyond the last station are not polled: V(FUN) and V(NUN).
FfRules ff_rules_of(const LinkDescription& link) {
  FfRules rules;
  rules.link.bit_rate = link.bit_rate;
  std::uint8_t last = 0;
  for (const auto* nodes : {&link.masters, &link.devices}) {
    for (const std::uint8_t node : *nodes) last = std::max(last, node);
  }
  rules.first_unpolled = static_cast<std::uint8_t>(std::min<unsigned>(last + 1U, rules.last_node));
  rules.unpolled = rules.last_node - std::min<unsigned>(last, rules.last_node);
  return rules;
}

Octets octets_of_word(std::uint16_t word) {
  return {static_cast<std::uint8_t>(word >> 8), static_cast<std::uint8_t>(word & 0xFF)};
}

FfDlpdu word_dlpdu() {
  return {.type = FfType::dt3, .data = Octets(kWordOctets)};
}

}  // namespace

FfNetwork::FfNetwork(const LinkDescription& description, std::uint64_t seed, const FfStations& stations)
    : LinkNetwork(description, ff_rules_of(description).link, seed), rules_(ff_rules_of(description)) {
  find_addresses();
  for (std::size_t n = 0; n < description.masters.size(); ++n) {
    add(description.masters[n], n + 1, fmt::format("ff_las@{}", n + 1), stations.make_master, true);
  }
  for (std::size_t n = 0; n < description.devices.size(); ++n) {
    add(description.devices[n], n + 1, fmt::format("ff_device@{}", n + 1), stations.make_device, false);
  }
  set_cycles(kinds(), response_delay(rules_.link), "at most V(MRD) x V(ST)");
}

void FfNetwork::add(std::uint8_t node, std::size_t position, const std::string& name,
                    const FfStations::Make& make, bool is_master) {
  Station& station = stations_.emplace_back();
  station.node = node;
  station.configuration = configuration_of(node, is_master);
  station.device = make ? make(position, station.configuration) : nullptr;
  const bool is_under_test = station.device != nullptr;
  if (!is_under_test) {
    station.device = is_master ? std::make_unique<FfLas>(station.configuration)
                               : std::make_unique<FfStation>(station.configuration);
  }
  station.user = std::make_unique<User>(*this);
  station.device->wire(seat(*station.device, node, name, is_under_test), *station.user);
}

void FfNetwork::find_addresses() {
  std::map<std::uint8_t, std::uint8_t> next_selector;  // by node
  for (const DataDescription& item : description().data) {
    const std::uint8_t selector = next_selector.try_emplace(item.from, kFirstSelector).first->second++;
    signal_of_address_[address_of(item.from, selector)] = addresses_.size();
    addresses_.push_back(address_of(item.from, selector));
  }
}

FfConfiguration FfNetwork::configuration_of(std::uint8_t node, bool is_master) const {
  FfConfiguration configuration;
  configuration.rules = rules_;
  configuration.node = node;
  const LinkDescription& link = description();
  for (std::size_t n = 0; n < link.data.size(); ++n) {
    if (link.data[n].from == node) configuration.published.push_back(addresses_[n]);
    if (link.data[n].to == node) configuration.subscribed.push_back(addresses_[n]);
  }
  if (!is_master) return configuration;
  configuration.begins_as_scheduler = node == link.masters.front();
  configuration.schedule.macrocycle = static_cast<std::uint32_t>(link.macrocycle / kTick);
  for (std::size_t n = 0; n < link.data.size(); ++n) {
    configuration.schedule.items.push_back(
        {static_cast<std::uint32_t>(link.data[n].at / kTick), addresses_[n], Priority::normal});
  }
  return configuration;
}

// A rotation visits each station with an empty token, probes once, and distributes time; what the schedule
// takes of the line, with what is kept free in front of each item, comes on top.
std::vector<network::CycleKind> FfNetwork::kinds() const {
  const LinkRules& link = rules_.link;
  const auto frame = [&](const FfDlpdu& dlpdu) { return frame_time(link, octets_on_line(dlpdu, rules_)); };
  const Duration gap = octets(link, link.inter_pdu_delay_octets);
  const auto stations = static_cast<std::int64_t>(stations_.size());
  const Duration visit = frame({.type = FfType::pt}) + frame({.type = FfType::rt}) + 2 * gap;
  const Duration probe =
      frame({.type = FfType::pn}) + response_delay(link) + frame({.type = FfType::pr}) + 2 * gap;
  const Duration time = frame({.type = FfType::td}) + gap;
  const Duration kept_free = octets(link, rules_.least_token_octets + rules_.scheduling_overhead_octets);
  const Duration item = frame({.type = FfType::cd}) + frame(word_dlpdu()) + 3 * gap + kept_free + visit;
  const Duration alone = stations * visit + probe + time;
  const Duration scheduled = static_cast<std::int64_t>(description().data.size()) * item;
  const double left = std::max(0.05, 1 - static_cast<double>(scheduled.count()) /
                                             static_cast<double>(description().macrocycle.count()));
  const Duration rotation =
      Duration{static_cast<std::int64_t>(static_cast<double>(alone.count()) / left)} + scheduled;
  return {
      {"macrocycle", description().macrocycle,
       "as the schedule has it; an item may be late by V(MSO) and a tick", false,
       octets(link, rules_.scheduling_overhead_octets) + kTick},
      {"token rotation", rotation,
       "empty tokens to all stations, a probe, a distribution of time, over the share of the line that the "
       "schedule leaves",
       true}};
}

std::shared_ptr<const trace::Dissector> FfNetwork::dissector() const {
  return std::make_shared<LinkDissector>(rules_);
}

std::vector<network::ProtectedFrame> FfNetwork::protected_frames() const {
  return {{"DT3", "CRC-16/PROFIBUS", static_cast<unsigned>(8 * octets_on_line(word_dlpdu(), rules_)),
           description().macrocycle / static_cast<std::int64_t>(description().data.size())}};
}

void FfNetwork::power_up(Time now) {
  for (Station& station : stations_) station.device->start(now);
}

void FfNetwork::power_down(Time now) {
  for (Station& station : stations_) station.device->stop(now);
}

void FfNetwork::give(std::size_t signal, std::uint16_t word, Time now) {
  const auto station = std::ranges::find(stations_, description().data[signal].from, &Station::node);
  station->device->write(addresses_[signal], octets_of_word(word), now);
}

void FfNetwork::on_published(const User& user, const FfDlpdu& dlpdu, Time when) {
  const auto station =
      std::ranges::find_if(stations_, [&](const Station& one) { return one.user.get() == &user; });
  const auto found = signal_of_address_.find(dlpdu.source);
  if (found == signal_of_address_.end() || description().data[found->second].to != station->node) return;
  // Of another length it is no word that anybody has sent.
  const bool is_word = dlpdu.data.size() == kWordOctets;
  on_got(found->second,
         is_word ? static_cast<std::uint16_t>(dlpdu.data[0] << 8 | dlpdu.data[1]) : std::uint16_t{0}, when);
}

bool FfNetwork::has_master(std::uint8_t node) const {
  return std::ranges::find(description().masters, node) != description().masters.end();
}

void FfNetwork::on_driven(const Octets& octets, Time begin, Time end) {
  const auto dlpdu = ff_dlpdu_of(octets, rules_);
  if (!dlpdu) return;
  if (dlpdu->type == FfType::pt && !description().devices.empty() &&
      dlpdu->node == description().devices.front()) {
    begin_cycle(1, begin);
  }
  if (dlpdu->type != FfType::cd && dlpdu->type != FfType::dt3) return;
  const bool is_call = dlpdu->type == FfType::cd;
  const FfAddress address = is_call ? dlpdu->destination : dlpdu->source;
  const auto found = signal_of_address_.find(address);
  if (found == signal_of_address_.end()) return;
  const std::size_t signal = found->second;
  const bool is_of_master = has_master(description().data[signal].from);
  if (is_call || (is_of_master && !is_called(signal))) on_called(signal, begin, end);
  if (is_call) {
    ask(description().data[signal].from, end);
  } else {
    on_sent(signal);
  }
}

Duration FfNetwork::answer_time() const {
  return response_delay(rules_.link) + frame_time(rules_.link, octets_on_line(word_dlpdu(), rules_));
}

Duration FfNetwork::least_delay(std::size_t signal) const {
  const auto frame = [&](const FfDlpdu& dlpdu) {
    return frame_time(rules_.link, octets_on_line(dlpdu, rules_));
  };
  const Duration call = frame({.type = FfType::cd}) + octets(rules_.link, rules_.link.inter_pdu_delay_octets);
  const bool is_of_scheduler = description().data[signal].from == description().masters.front();
  return lead() + (is_of_scheduler ? Duration{} : call) + frame(word_dlpdu());
}

}  // namespace fieldproof::fieldbus_dll
