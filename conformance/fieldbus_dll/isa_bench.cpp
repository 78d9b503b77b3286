#include "conformance/fieldbus_dll/isa_bench.hpp"

#include <algorithm>

#include "conformance/fieldbus_dll/link_sequence.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/fieldbus_dll/isa_settings.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::IsaConfiguration;

IsaConfiguration configuration_of(const IsaNeeds& needs, const IsaSetting& setting) {
  IsaConfiguration configuration;
  configuration.rules.link.bit_rate = needs.bit_rate;
  configuration.address = needs.is_in_standby ? kIsaStationAddress : setting.address;
  configuration.schedule = needs.schedule;
  configuration.begins_as_scheduler = needs.is_scheduler && !needs.is_in_standby;
  if (needs.change) needs.change(configuration);
  field::take_settings(fieldbus_dll::kIsaTable, setting.settings, configuration);
  return configuration;
}

}  // namespace

void expect_judgeable_isa(const IsaConfiguration& station) {
  const fieldbus_dll::IsaRules& rules = station.rules;
  expect_time_for_answers(rules.link);
  const unsigned patience = 2 * rules.link.response_delay_slots * rules.link.slot_time_octets;
  if (rules.link.inter_pdu_delay_octets < rules.reply_forming_octets &&
      rules.reply_forming_octets < rules.reply_wait_octets &&
      rules.reply_wait_octets + octets_around(rules.link) + rules.link.inter_pdu_delay_octets < patience)
    return;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format("a reply begins after V(MID), within V(FD), and is waited for longer, but not "
                  "twice V(MRD) x V(ST): V(MID) is {} octets, V(FD) {} and V(RR) {}",
                  rules.link.inter_pdu_delay_octets, rules.reply_forming_octets, rules.reply_wait_octets));
}

bool IsaUpperTester::was_delivered(const Octets& data) const {
  return std::ranges::any_of(deliveries, [&](const Delivery& one) { return one.dlpdu.data == data; });
}

IsaBench::IsaBench(const IsaNeeds& needs, const IsaSetting& setting)
    : LinkBench(configuration_of(needs, setting).rules.link, setting.seed, setting.volume,
                setting.link_stresses),
      configuration_(configuration_of(needs, setting)),
      is_in_standby_(needs.is_in_standby),
      station_(setting.make_device(configuration_)) {
  start_recording(setting, rules());
  station_->wire(attach_station(*station_, setting.plan), user_);
  has_started_ = station_->start(now());
  refresh_iut();
}

bool IsaBench::submit(fieldbus_dll::IsaService service, Priority priority, const Octets& data,
                      std::uint8_t destination) {
  const bool is_taken = station_->submit({service, priority, destination, data}, now());
  refresh_iut();
  return is_taken;
}

bool IsaBench::order_transfer(std::uint8_t node) {
  const bool is_taken = station_->order_transfer(node, now());
  refresh_iut();
  return is_taken;
}

bool IsaBench::ask_user_request(const Octets& request) {
  const bool is_taken = station_->ask(request, now());
  refresh_iut();
  return is_taken;
}

std::string IsaReport::text() const {
  return data ? describe(*data) : fmt::format("{} of {:02X}", text_of(event.kind), event.node);
}

void IsaBench::set_supply(bool is_on) {
  if (is_on) {
    has_started_ = station_->start(now());
  } else {
    station_->stop(now());
  }
  note_supply(is_on);
  refresh_iut();
}

std::string IsaBench::words(const DrivenDlpdu& dlpdu) const {
  return dlpdu.has_right_check ? words_of(dlpdu.octets, rules()) : dlpdu.text();
}

// ---- DLPDUs of the tester ----

Octets IsaBench::et(Priority least) const {
  return {control(rules().codes.et, least), address(), kScheduler};
}

void IsaBench::ask() {
  send(et(Priority::time_available));
  next();
}

Octets IsaBench::es(Priority least, unsigned duration) const {
  return {control(rules().codes.es, least), address(), kScheduler, static_cast<std::uint8_t>(duration >> 8),
          static_cast<std::uint8_t>(duration & 0xFF)};
}

Octets IsaBench::cd(Priority least) const {
  return {control(rules().codes.cd, least), address(), kPeer};
}

Octets IsaBench::dt(Priority priority, const Octets& data, std::uint8_t source) const {
  constexpr std::uint8_t kFinal = 0x04;
  Octets octets{static_cast<std::uint8_t>(control(rules().codes.dt, priority) | kFinal), address(), source};
  octets.insert(octets.end(), data.begin(), data.end());
  return octets;
}

Octets IsaBench::ee(std::uint8_t source) const {
  constexpr std::uint8_t kFinal = 0x04;
  return {static_cast<std::uint8_t>(rules().codes.ee | kFinal), address(), source, 0};
}

}  // namespace fieldproof::conformance
