#include "protocols/fieldbus_dll/isa_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "protocols/fieldbus_dll/isa_las.hpp"
#include "protocols/fieldbus_dll/link_dissector.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using kernel::Duration;
using kernel::Time;

// What is sent says which word it is: number, value.
constexpr std::size_t kDataOctets = 3;
constexpr unsigned kMarginOctets = 8;

IsaRules isa_rules_of(const LinkDescription& link) {
  IsaRules rules;
  rules.link.bit_rate = link.bit_rate;
  return rules;
}

// Nobody but the scheduler drives before it has got a token, and who has no word gets none.
std::string why_silent(const LinkDescription& link, std::uint8_t node) {
  const auto has_word = [node](const DataDescription& item) { return item.from == node || item.to == node; };
  if (node == link.masters.front() || std::ranges::any_of(link.data, has_word)) return {};
  return "the schedule gives the token to who has a word to send, and no item of \"data\" is from it, or to "
         "it";
}

}  // namespace

IsaNetwork::IsaNetwork(const LinkDescription& description, std::uint64_t seed, const IsaStations& stations)
    : LinkNetwork(description, isa_rules_of(description).link, seed), rules_(isa_rules_of(description)) {
  for (std::size_t n = 0; n < description.masters.size(); ++n) {
    add(description.masters[n], n + 1, fmt::format("isa_las@{}", n + 1), stations.make_master, true);
  }
  for (std::size_t n = 0; n < description.devices.size(); ++n) {
    add(description.devices[n], n + 1, fmt::format("isa_dle@{}", n + 1), stations.make_device, false);
  }
  set_cycles(kinds(), {}, "no closed form: its own rules say how long it may prepare");
}

void IsaNetwork::add(std::uint8_t node, std::size_t position, const std::string& name,
                     const IsaStations::Make& make, bool is_master) {
  IsaConfiguration configuration;
  configuration.rules = rules_;
  configuration.address = node;
  configuration.begins_as_scheduler = is_master && node == description().masters.front();
  if (is_master) {
    configuration.schedule.period = description().macrocycle;
    for (const DataDescription& item : description().data) {
      configuration.schedule.items.push_back(
          {item.at, IsaType::es, item.from, Priority::time_available, token_octets()});
    }
  }
  Station& station = stations_.emplace_back();
  station.node = node;
  station.device = make ? make(position, configuration) : nullptr;
  const bool is_under_test = station.device != nullptr;
  if (!is_under_test) {
    station.device =
        is_master ? std::make_unique<IsaLas>(configuration) : std::make_unique<IsaDle>(configuration);
  }
  station.user = std::make_unique<User>(*this, node);
  station.device->wire(seat(*station.device, node, name, is_under_test, why_silent(description(), node)),
                       *station.user);
}

// One DU, the return of the token, and the silences in front of both.
std::uint16_t IsaNetwork::token_octets() const {
  const unsigned frames =
      static_cast<unsigned>(octets_on_line(IsaType::du, kDataOctets) + octets_on_line(IsaType::ee)) +
      2 * octets_around(rules_.link);
  return static_cast<std::uint16_t>(frames + 2 * rules_.link.inter_pdu_delay_octets + kMarginOctets);
}

std::vector<network::CycleKind> IsaNetwork::kinds() const {
  const Duration jitter = octets(rules_.link, 2 * rules_.link.inter_pdu_delay_octets);
  return {{"macrocycle", description().macrocycle, "period of the schedule", false, jitter},
          {"token rotation", description().macrocycle,
           "the schedule delegates the token for the first word once in a period", false, jitter}};
}

std::shared_ptr<const trace::Dissector> IsaNetwork::dissector() const {
  return std::make_shared<LinkDissector>(rules_);
}

std::vector<network::ProtectedFrame> IsaNetwork::protected_frames() const {
  return {{"DU", "CRC-16/PROFIBUS", static_cast<unsigned>(8 * octets_on_line(IsaType::du, kDataOctets)),
           description().macrocycle / static_cast<std::int64_t>(description().data.size())}};
}

void IsaNetwork::power_up(Time now) {
  for (Station& station : stations_) station.device->start(now);
}

void IsaNetwork::power_down(Time now) {
  for (Station& station : stations_) station.device->stop(now);
  waiting_.clear();
}

// The application submits one word at a time: what waits for a token that was lost goes first.
void IsaNetwork::give(std::size_t signal, std::uint16_t word, Time now) {
  if (std::ranges::find(waiting_, signal) != waiting_.end()) return;
  const DataDescription& item = description().data[signal];
  const auto station = std::ranges::find(stations_, item.from, &Station::node);
  const bool is_taken = station->device->submit(
      {.service = IsaService::unit_data,
       .priority = Priority::normal,
       .destination = item.to,
       .data = {static_cast<std::uint8_t>(signal), static_cast<std::uint8_t>(word >> 8),
                static_cast<std::uint8_t>(word & 0xFF)}},
      now);
  if (is_taken) waiting_.push_back(signal);
}

void IsaNetwork::on_data(std::uint8_t node, const IsaDlpdu& dlpdu, Time when) {
  const auto& data = description().data;
  for (std::size_t n = 0; n < data.size(); ++n) {
    if (data[n].to != node || data[n].from != dlpdu.source) continue;
    const bool is_word = dlpdu.data.size() == kDataOctets;
    if (is_word && dlpdu.data[0] != static_cast<std::uint8_t>(n)) continue;
    on_got(n, is_word ? static_cast<std::uint16_t>(dlpdu.data[1] << 8 | dlpdu.data[2]) : std::uint16_t{0},
           when);
    if (std::ranges::find(data, node, &DataDescription::from) == data.end()) take_part(node);
  }
}

// What a station has submitted goes out in this order, one under each token: after a token that was lost, a
// word goes with the next one, and not with that of its own place in the schedule.
std::size_t IsaNetwork::called_by_token(std::uint8_t node) const {
  const auto& data = description().data;
  const auto waits = [&](std::size_t signal) { return data[signal].from == node; };
  if (const auto first = std::ranges::find_if(waiting_, waits); first != waiting_.end()) return *first;
  return static_cast<std::size_t>(std::ranges::find(data, node, &DataDescription::from) - data.begin());
}

void IsaNetwork::on_driven(const Octets& octets, Time begin, Time end) {
  const auto dlpdu = isa_dlpdu_of(octets, rules_);
  if (!dlpdu) return;
  const auto& data = description().data;
  if (dlpdu->type == IsaType::es) {
    const std::size_t signal = called_by_token(dlpdu->destination);
    if (signal == data.size()) return;
    if (signal == 0) begin_cycle(1, begin);
    on_called(signal, begin, end);
    ask(data[signal].from, end);
  } else if (dlpdu->type == IsaType::du && dlpdu->data.size() == kDataOctets &&
             dlpdu->data[0] < data.size()) {
    on_sent(dlpdu->data[0]);
    std::erase(waiting_, std::size_t{dlpdu->data[0]});
  }
}

Duration IsaNetwork::answer_time() const {
  return octets(rules_.link, token_octets() + rules_.supervision_margin_octets);
}

Duration IsaNetwork::least_delay(std::size_t) const {
  return lead() + frame_time(rules_.link, octets_on_line(IsaType::es)) +
         octets(rules_.link, rules_.link.inter_pdu_delay_octets) +
         frame_time(rules_.link, octets_on_line(IsaType::du, kDataOctets));
}

}  // namespace fieldproof::fieldbus_dll
