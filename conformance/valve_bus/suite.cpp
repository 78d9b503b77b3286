#include "conformance/valve_bus/suite.hpp"

#include <fmt/format.h>

#include "conformance/bench_role.hpp"
#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_mutants.hpp"
#include "conformance/valve_bus/host_sequence.hpp"
#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_mutants.hpp"
#include "conformance/valve_bus/node_sequence.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/valve_bus/attached_host.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/dissector.hpp"
#include "protocols/valve_bus/embedded_schemas.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::conformance {
namespace {

using valve_bus::FrameDissector;

// The cases speak to the ID that the node has.
void expect_an_id(const valve_bus::NodeConfiguration& node) {
  constexpr unsigned kDigits = 10;
  const bool are_digits = node.address_tens < kDigits && node.address_units < kDigits;
  if (are_digits && node.address_tens + node.address_units > 0) return;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format("address switches at {} and {} give no ID, so nothing can be sent to this node; "
                  "declare \"address_tens\" and \"address_units\" of 0 to 9, one of them above 0",
                  node.address_tens, node.address_units));
}

// A command, what follows from it and a wrong frame have to fit within the time after which its valves go
// off.
void expect_time_for_commands(const valve_bus::NodeConfiguration& node) {
  constexpr std::int64_t kExchanges = 40;
  constexpr std::int64_t kFrameBits = 11 * valve_bus::kCommandOctets;
  const valve_bus::Rules& rules = node.rules;
  const kernel::Duration least =
      kExchanges * (valve_bus::bits(rules, kFrameBits) + valve_bus::delimiter(rules) +
                    valve_bus::turnaround_time_span(rules));
  if (rules.loss_limit == kernel::Duration{} || rules.loss_limit >= least) return;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format(
          "with a \"loss_limit\" of {} the valves of this node go off within what cases do between two "
          "commands; at {} bit/s it can be judged from {} on",
          kernel::describe(rules.loss_limit), rules.bit_rate, kernel::describe(least)));
}

void expect_judgeable(const NodeCase&, const NodeSetting& setting, const RunningCase&) {
  const auto node =
      node_configuration({}, setting.pics.value_or(judge::Pics{}).completed_by(declared_node()));
  expect_an_id(node);
  expect_time_for_commands(node);
}

RoleRow node_row() {
  return row_of<valve_bus::NodeRole, valve_bus::Node>(
      {.what = "node of the valve bus",
       .mutants = node_mutants,
       .configuration = [] { return node_configuration({}, declared_node()); }},
      CaseRole<NodeCase, NodeSetting, FrameDissector>{
          .name = "node",
          .cases = node_cases,
          .check = expect_judgeable,
          .pics_items = node_pics_items,
          .usual_answers = declared_node,
          .settings = &valve_bus::kNodeTable,
          .sequences = SequenceRow<NodeCase>{node_sequence_role, run_node_sequence}});
}

RoleRow host_row() {
  return row_of<valve_bus::HostRole, valve_bus::Host>(
      {.what = "host of the valve bus",
       .mutants = host_mutants,
       .configuration = [] { return host_configuration({}, declared_host()); }},
      CaseRole<HostCase, HostSetting, FrameDissector>{
          .name = "host",
          .cases = host_cases,
          .pics_items = host_pics_items,
          .usual_answers = declared_host,
          .settings = &valve_bus::kHostTable,
          .sequences = SequenceRow<HostCase>{host_sequence_role, run_host_sequence}});
}

}  // namespace

std::unique_ptr<Suite> valve_bus_suite(SuiteGiven given) {
  return std::make_unique<Suite>(
      SuiteRows{.protocol = "valve_bus",
                .roles = {node_row(), host_row()},
                .rules = {{"rules", &valve_bus::kRulesTable}},
                .schemas = {{"network", valve_bus::network_schema}},
                .why_no_network = "cases of the valve bus make the line that they need; leave out the "
                                  "network, and say in a PICS what the implementation is"},
      std::move(given));
}

}  // namespace fieldproof::conformance
