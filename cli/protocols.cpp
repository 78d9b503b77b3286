#include "cli/protocols.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "cli/disturbances.hpp"
#include "conformance/assigned.hpp"
#include "conformance/fieldbus_dll/ff_mutants.hpp"
#include "conformance/fieldbus_dll/isa_mutants.hpp"
#include "conformance/fieldbus_dll/planned_network.hpp"
#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/interbus/declarations.hpp"
#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/planned_network.hpp"
#include "conformance/interbus/slave_mutants.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/token_bus/dual_channel_mutants.hpp"
#include "conformance/token_bus/planned_network.hpp"
#include "conformance/token_bus/station_mutants.hpp"
#include "conformance/token_bus/suite.hpp"
#include "conformance/token_bus/translator_mutants.hpp"
#include "conformance/valve_bus/declarations.hpp"
#include "conformance/valve_bus/host_mutants.hpp"
#include "conformance/valve_bus/node_bench.hpp"
#include "conformance/valve_bus/node_mutants.hpp"
#include "conformance/valve_bus/planned_network.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "emc/interbus/undetected_cycle.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/bandwidth/embedded_schemas.hpp"
#include "protocols/bandwidth/plan.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/fieldbus_dll/embedded_schemas.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"
#include "protocols/fieldbus_dll/isa_las.hpp"
#include "protocols/fieldbus_dll/target_plan_text.hpp"
#include "protocols/interbus/attached_master.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/slave.hpp"
#include "protocols/interbus/telegram_speaker.hpp"
#include "protocols/token_bus/attached_dual_channel.hpp"
#include "protocols/token_bus/attached_station.hpp"
#include "protocols/token_bus/attached_translator.hpp"
#include "protocols/token_bus/dual_channel.hpp"
#include "protocols/token_bus/token_station.hpp"
#include "protocols/token_bus/translator.hpp"
#include "protocols/valve_bus/attached_host.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/node.hpp"
#include "protocols/valve_bus/uart.hpp"

namespace fieldproof::cli {
namespace {

template <typename Kind, typename Reference, auto mutants>
std::unique_ptr<iut::Device> serve(const std::string& uri) {
  const bool is_reference = uri == conformance::kReferenceUri;
  const std::string name = is_reference ? "" : conformance::mutant_of(uri, "built-in station");
  if (!is_reference) mutants().maker(name);  // while it is the caller's mistake
  return std::make_unique<typename Kind::Served>([is_reference, name](const auto& configuration) {
    return is_reference ? std::make_unique<Reference>(configuration) : mutants().make(name, configuration);
  });
}

template <typename Kind>
std::unique_ptr<iut::Device> in_levels(iut::Attachment attachment, const iut::CaseBegin& begin) {
  return std::make_unique<typename Kind::Served>([attachment, begin](const auto& configuration) {
    return std::make_unique<typename Kind::Attached>(attachment, configuration, begin.id, begin.seed);
  });
}

// ---- serial lines ----

// The words of a PICS for the format of a UART.
std::string characters_of(const std::string& uri, const line::CharacterFormat& format) {
  const std::string text = format.text();
  if (text == "8m1") return "P0";
  if (text == "8e1") return "P1";
  if (text == "8n1") return "P2";
  throw kernel::Error(
      kernel::ErrorKind::usage,
      fmt::format("'{}': no station of the valve bus sends characters {}; there are 8m1 (a ninth "
                  "bit of 1), 8e1 and 8n1",
                  uri, text));
}

// Without an upper channel the box is as it stands there.
judge::Pics station_on_line(const std::string& uri, const iut::SerialSettings& settings) {
  judge::Pics pics;
  if (settings.format) pics.declare("characters", characters_of(uri, *settings.format));
  pics.declare("power_can_be_switched", !settings.upper.empty());
  return pics;
}

judge::Pics node_on_line(const std::string& uri, const iut::SerialSettings& settings) {
  judge::Pics pics = station_on_line(uri, settings);
  if (settings.bit_rate) pics.declare("bit_rate", *settings.bit_rate);
  pics.declare("address_switches_can_be_set", !settings.upper.empty());
  return pics;
}

// The bit rate is that of a position of its switches, and the line has one bit rate.
judge::Pics host_on_line(const std::string& uri, const iut::SerialSettings& settings) {
  judge::Pics pics = station_on_line(uri, settings);
  pics.declare("dip_can_be_set", false);
  if (!settings.bit_rate) return pics;
  const auto rates = valve_bus::dip_bit_rates();
  const auto found = std::ranges::find(rates, *settings.bit_rate);
  if (found == rates.end()) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("'{}': no position of the DIP switches of a host is {} bit/s; there are {}", uri,
                    *settings.bit_rate, fmt::join(rates, ", ")));
  }
  pics.declare("dip", static_cast<std::int64_t>(found - rates.begin()));
  return pics;
}

iut::UartLine node_uart(const iut::CaseBegin& begin) {
  return valve_bus::uart_line(valve_bus::node_configuration_of(begin).rules);
}
iut::UartLine host_uart(const iut::CaseBegin& begin) {
  valve_bus::HostConfiguration host = valve_bus::host_configuration_of(begin);
  host.rules.bit_rate = valve_bus::dip_bit_rates()[host.dip];
  return valve_bus::asking_uart_line(host.rules);
}
constexpr std::array kHostInputs{valve_bus::kDip};
constexpr std::array kNodeInputs{valve_bus::kLimitSwitches};
iut::CaseBegin node_alone(const judge::Pics& pics) {
  const auto configuration =
      conformance::node_configuration({}, pics.completed_by(conformance::declared_node()));
  return {"valve_bus/node/alone", 1, valve_bus::node_settings(configuration)};
}

// ---- telegrams ----

template <unsigned line_ports>
std::unique_ptr<iut::Device> in_telegrams(std::unique_ptr<iut::Device> station) {
  return std::make_unique<interbus::TelegramSpeaker>(std::move(station), line_ports);
}

// ---- rows ----

template <typename Kind, typename Reference, auto mutants>
constexpr Role row(iut::UnitOffer units) {
  return {Kind::protocol, Kind::role, units, &serve<Kind, Reference, mutants>, &in_levels<Kind>};
}

constexpr Role with_telegrams(Role role, decltype(Role::in_telegrams) in_telegrams) {
  role.in_telegrams = in_telegrams;
  return role;
}

constexpr Role with_uart(Role role, iut::MakeUartLine uart, decltype(Role::on_line) on_line,
                         std::span<const iut::Item> inputs, decltype(Role::alone) alone = nullptr) {
  role.uart = uart;
  role.on_line = on_line;
  role.inputs = inputs;
  role.alone = alone;
  return role;
}

constexpr auto kInItsUnit = iut::UnitOffer::in_its_unit;
constexpr auto kCharactersToo = iut::UnitOffer::in_characters_too;

constexpr std::array kInterbusRoles{
    with_telegrams(row<interbus::SlaveRole, interbus::Slave, &conformance::slave_mutants>(kInItsUnit),
                   &in_telegrams<3>),
    with_telegrams(row<interbus::MasterRole, interbus::Master, &conformance::master_mutants>(kCharactersToo),
                   &in_telegrams<1>),
};
constexpr std::array kValveBusRoles{
    with_uart(row<valve_bus::NodeRole, valve_bus::Node, &conformance::node_mutants>(kInItsUnit), node_uart,
              node_on_line, kNodeInputs, node_alone),
    with_uart(row<valve_bus::HostRole, valve_bus::Host, &conformance::host_mutants>(kCharactersToo),
              host_uart, host_on_line, kHostInputs),
};
constexpr std::array kFieldbusDllRoles{
    row<fieldbus_dll::IsaDleRole, fieldbus_dll::IsaDle, &conformance::isa_dle_mutants>(kCharactersToo),
    row<fieldbus_dll::IsaLasRole, fieldbus_dll::IsaLas, &conformance::isa_las_mutants>(kCharactersToo),
    row<fieldbus_dll::FfDeviceRole, fieldbus_dll::FfStation, &conformance::ff_device_mutants>(kCharactersToo),
    row<fieldbus_dll::FfLasRole, fieldbus_dll::FfLas, &conformance::ff_las_mutants>(kCharactersToo),
};
constexpr std::array kTokenBusRoles{
    row<token_bus::StationRole, token_bus::TokenStation, &conformance::token_station_mutants>(kInItsUnit),
    row<token_bus::TranslatorRole, token_bus::Translator, &conformance::translator_mutants>(kInItsUnit),
    row<token_bus::ChannelManagerRole, token_bus::ChannelManager, &conformance::channel_manager_mutants>(
        kInItsUnit),
};

Planned token_plan(const config::Document& file, std::uint64_t seed) {
  const auto network = fieldbus_dll::TokenNetwork::read(file);
  const auto plan = fieldbus_dll::plan_target(network.traffic, network.bound, seed);
  return {fieldbus_dll::network_text(network, seed) + fieldbus_dll::plan_text(plan, network),
          fieldbus_dll::plan_json(plan, network, seed), plan.is_proven, plan.is_open};
}
std::vector<field::NamedSchema> token_schemas() {
  return {{"token_network", fieldbus_dll::token_network_schema},
          {"target_plan", fieldbus_dll::target_plan_schema}};
}

Planned bandwidth_plan(const config::Document& file, std::uint64_t seed) {
  const bandwidth::Plan plan = bandwidth::plan_bandwidth(bandwidth::Network::read(file), seed);
  return {bandwidth::plan_text(plan), bandwidth::plan_json(plan), plan.is_proven()};
}
std::vector<field::NamedSchema> bandwidth_schemas() {
  return {{"network", bandwidth::bandwidth_network_schema}, {"plan", bandwidth::bandwidth_plan_schema}};
}

std::vector<UndetectedPart> undetected_cycles(const std::string& network_file, double flip_probability) {
  const emc::UndetectedCycle parts =
      emc::undetected_cycle(conformance::planned_interbus_network(network_file), flip_probability);
  return {{"code_word", parts.by_code_word}, {"shift", parts.by_shift}, {"misframing", parts.by_misframing}};
}

constexpr std::array kProtocols{
    ProtocolEntry{
        .name = "interbus",
        .roles = kInterbusRoles,
        .suite = conformance::interbus_suite,
        .network = {.own_network = "of the cycle-time paper",
                    .plan = conformance::plan_interbus,
                    .has_latch_models = true},
        .undetected = {undetected_cycles,
                       "That a flipped header level moves the end of the data, and how often a check "
                       "fits then, follows from this project's reading of the header: the simulated "
                       "stations and the theory share it."}},
    ProtocolEntry{.name = "valve_bus",
                  .roles = kValveBusRoles,
                  .suite = conformance::valve_bus_suite,
                  .network = {.own_network = "of 8 nodes on 1000 m", .plan = conformance::plan_valve_bus}},
    ProtocolEntry{
        .name = "fieldbus_dll",
        .roles = kFieldbusDllRoles,
        .suite = conformance::fieldbus_dll_suite,
        .network = {.own_network = "of two link masters and 4 devices", .plan = conformance::plan_link},
        .planner = {.file = "token_network", .key = "urgent_delay", .plan = token_plan},
        .schemas = token_schemas},
    ProtocolEntry{.name = "token_bus",
                  .roles = kTokenBusRoles,
                  .suite = conformance::token_bus_suite,
                  .network = {.own_network = "of 4 stations", .plan = conformance::plan_token_bus}},
    // A scheme for any cyclic server: nothing of it is attached or judged.
    ProtocolEntry{.name = "bandwidth",
                  .planner = {.file = "network", .key = "loops", .plan = bandwidth_plan},
                  .schemas = bandwidth_schemas},
};

}  // namespace

std::span<const ProtocolEntry> built_in_protocols() {
  return kProtocols;
}

Suites built_in_suites() {
  use_protocols(kProtocols);
  return make_suites(all_disturbances());
}

}  // namespace fieldproof::cli
