#include "cli/protocols.hpp"

#include <array>

#include "cli/attachments.hpp"
#include "conformance/assigned.hpp"
#include "conformance/fieldbus_dll/ff_mutants.hpp"
#include "conformance/fieldbus_dll/isa_mutants.hpp"
#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/interbus/declarations.hpp"
#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/slave_mutants.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/valve_bus/declarations.hpp"
#include "conformance/valve_bus/host_mutants.hpp"
#include "conformance/valve_bus/node_bench.hpp"
#include "conformance/valve_bus/node_mutants.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"
#include "protocols/fieldbus_dll/isa_las.hpp"
#include "protocols/fieldbus_dll/target_plan_text.hpp"
#include "protocols/interbus/attached_master.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/slave.hpp"
#include "protocols/interbus/telegram_speaker.hpp"
#include "protocols/valve_bus/attached_host.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/node.hpp"
#include "protocols/valve_bus/uart.hpp"

namespace fieldproof::cli {
namespace {

// `make_mutant` gives the station of a mutant by its name.
template <typename Kind, typename Reference, auto make_mutant>
std::unique_ptr<iut::Device> serve(const std::string& uri) {
  const bool is_reference = uri == conformance::kReferenceUri;
  const std::string name = is_reference ? "" : conformance::mutant_of(uri, "built-in station");
  if (!is_reference) make_mutant(name, {});  // while it is the caller's mistake
  return std::make_unique<typename Kind::Served>([is_reference, name](const auto& configuration) {
    return is_reference ? std::make_unique<Reference>(configuration) : make_mutant(name, configuration);
  });
}

template <typename Kind>
std::unique_ptr<iut::Device> in_levels(iut::Attachment attachment, const iut::CaseBegin& begin) {
  return std::make_unique<typename Kind::Served>([attachment, begin](const auto& configuration) {
    return std::make_unique<typename Kind::Attached>(attachment, configuration, begin.id, begin.seed);
  });
}

constexpr const char kIsaDle[] = "isa_dle";
constexpr const char kIsaLas[] = "isa_las";
constexpr const char kFfDevice[] = "ff_device";
constexpr const char kFfLas[] = "ff_las";

// Mutants of the data link stand in one table for both roles of a profile.
template <const char* role>
std::unique_ptr<fieldbus_dll::IsaDevice> isa_mutant_of(const std::string& name,
                                                       const fieldbus_dll::IsaConfiguration& of) {
  return conformance::make_isa_mutant(role, name, of);
}
template <const char* role>
std::unique_ptr<fieldbus_dll::FfDevice> ff_mutant_of(const std::string& name,
                                                     const fieldbus_dll::FfConfiguration& of) {
  return conformance::make_ff_mutant(role, name, of);
}

// ---- serial lines ----

iut::UartLine node_uart(const iut::CaseBegin& begin) {
  return valve_bus::uart_line(valve_bus::node_configuration_of(begin).rules);
}
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

template <typename Kind, typename Reference, auto make_mutant>
constexpr Role row(iut::UnitOffer told) {
  return {Kind::protocol, Kind::role, told, &serve<Kind, Reference, make_mutant>, &in_levels<Kind>};
}

constexpr Role with_telegrams(Role role, decltype(Role::in_telegrams) in_telegrams) {
  role.in_telegrams = in_telegrams;
  return role;
}

constexpr Role with_uart(Role role, iut::MakeUartLine uart, std::span<const iut::Item> inputs,
                         decltype(Role::alone) alone) {
  role.uart = uart;
  role.inputs = inputs;
  role.alone = alone;
  return role;
}

constexpr Role without_serial(Role role, std::string_view why) {
  role.why_not_serial = why;
  return role;
}

constexpr Role with_pics(Role role, decltype(Role::pics_items) items, decltype(Role::declared) declared) {
  role.pics_items = items;
  role.declared = declared;
  return role;
}

// As the bench's own network has it.
judge::Pics declared_usual_slave() {
  interbus::SlaveConfiguration usual;
  usual.id_code = 0x0203;
  usual.words = 2;
  return conformance::declared_slave(usual);
}

constexpr auto kInItsUnit = iut::UnitOffer::in_its_unit;
constexpr auto kCharactersToo = iut::UnitOffer::in_characters_too;

constexpr std::array kInterbusRoles{
    with_pics(
        with_telegrams(row<interbus::SlaveRole, interbus::Slave, &conformance::make_slave_mutant>(kInItsUnit),
                       &in_telegrams<3>),
        conformance::slave_pics_items, declared_usual_slave),
    with_pics(with_telegrams(row<interbus::MasterRole, interbus::Master, &conformance::make_master_mutant>(
                                 kCharactersToo),
                             &in_telegrams<1>),
              conformance::master_pics_items, conformance::declared_master),
};
constexpr std::array kValveBusRoles{
    with_pics(with_uart(row<valve_bus::NodeRole, valve_bus::Node, &conformance::make_node_mutant>(kInItsUnit),
                        node_uart, kNodeInputs, node_alone),
              conformance::node_pics_items, conformance::declared_node),
    with_pics(without_serial(
                  row<valve_bus::HostRole, valve_bus::Host, &conformance::make_host_mutant>(kCharactersToo),
                  "it begins exchanges by itself, and its cases know no uncertainty of instants"),
              conformance::host_pics_items, conformance::declared_host),
};
constexpr std::array kFieldbusDllRoles{
    row<fieldbus_dll::IsaDleRole, fieldbus_dll::IsaDle, &isa_mutant_of<kIsaDle>>(kCharactersToo),
    row<fieldbus_dll::IsaLasRole, fieldbus_dll::IsaLas, &isa_mutant_of<kIsaLas>>(kCharactersToo),
    row<fieldbus_dll::FfDeviceRole, fieldbus_dll::FfStation, &ff_mutant_of<kFfDevice>>(kCharactersToo),
    row<fieldbus_dll::FfLasRole, fieldbus_dll::FfLas, &ff_mutant_of<kFfLas>>(kCharactersToo),
};

std::unique_ptr<conformance::Suite> interbus_suite(const conformance::Attach& attach,
                                                   const Disturbances& disturbances) {
  return conformance::interbus_suite(
      {.attach = attach, .disturbances = disturbances.of_plans, .stresses = disturbances.stresses});
}

std::unique_ptr<conformance::Suite> valve_bus_suite(const conformance::Attach& attach,
                                                    const Disturbances& disturbances) {
  return conformance::valve_bus_suite({.attach = attach,
                                       .on_real_line = station_on_real_line,
                                       .disturbances = disturbances.of_plans,
                                       .stresses = disturbances.stresses});
}

std::unique_ptr<conformance::Suite> fieldbus_dll_suite(const conformance::Attach& attach,
                                                       const Disturbances& disturbances) {
  return conformance::fieldbus_dll_suite(
      {.attach = attach, .disturbances = disturbances.of_plans, .stresses = disturbances.link_stresses});
}

Planned token_plan(const std::string& file, std::uint64_t seed) {
  const auto network = fieldbus_dll::TokenNetwork::load(file);
  const auto plan = fieldbus_dll::plan_target(network.traffic, network.bound, seed);
  return {fieldbus_dll::network_text(network, seed) + fieldbus_dll::plan_text(plan, network), plan.is_proven};
}

constexpr std::array kProtocols{
    ProtocolEntry{"interbus", kInterbusRoles, interbus_suite},
    ProtocolEntry{"valve_bus", kValveBusRoles, valve_bus_suite},
    ProtocolEntry{"fieldbus_dll", kFieldbusDllRoles, fieldbus_dll_suite, token_plan},
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
