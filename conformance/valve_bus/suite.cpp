#include "conformance/valve_bus/suite.hpp"

#include "conformance/bench_role.hpp"
#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/host_mutants.hpp"
#include "conformance/valve_bus/host_sequence.hpp"
#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/node_mutants.hpp"
#include "conformance/valve_bus/node_sequence.hpp"
#include "protocols/valve_bus/attached_host.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/dissector.hpp"
#include "protocols/valve_bus/embedded_schemas.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/node.hpp"

namespace fieldproof::conformance {
namespace {

using valve_bus::FrameDissector;

void expect_judgeable_node(const NodeCase&, const NodeSetting& setting, const RunningCase&) {
  expect_judgeable(
      node_configuration({}, setting.pics.value_or(judge::Pics{}).completed_by(declared_node())));
}

RoleRow node_row() {
  return row_of<valve_bus::NodeRole, valve_bus::Node>(
      {.what = "node of the valve bus",
       .mutants = node_mutants,
       .configuration = [] { return node_configuration({}, declared_node()); }},
      CaseRole<NodeCase, NodeSetting, FrameDissector>{
          .name = "node",
          .cases = node_cases,
          .check = expect_judgeable_node,
          .pics_items = node_pics_items,
          .usual_answers = declared_node,
          .settings = &valve_bus::kNodeTable,
          .are_settings_declared = true,
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
          .are_settings_declared = true,
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
