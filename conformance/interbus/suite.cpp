#include "conformance/interbus/suite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "conformance/bench_role.hpp"
#include "conformance/interbus/master_cases.hpp"
#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/master_sequence.hpp"
#include "conformance/interbus/network_bench.hpp"
#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_mutants.hpp"
#include "conformance/interbus/slave_sequence.hpp"
#include "harness/kernel/error.hpp"
#include "protocols/interbus/attached_master.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/cycle_dissector.hpp"
#include "protocols/interbus/embedded_schemas.hpp"
#include "protocols/interbus/master.hpp"
#include "protocols/interbus/master_settings.hpp"
#include "protocols/interbus/slave.hpp"
#include "protocols/interbus/slave_settings.hpp"

namespace fieldproof::conformance {
namespace {

using interbus::CycleDissector;
using interbus::NetworkDescription;

const Stations<interbus::SlaveRole> kSlaves{.what = "INTERBUS slave", .mutants = slave_mutants};
const Stations<interbus::MasterRole> kMasters{.what = "INTERBUS master", .mutants = master_mutants};

[[noreturn]] void refuse(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::usage, sentence);
}

// ---- slave ----

void put_at_position(SlaveSetting& setting, RunningCase& run) {
  const int position = run.assigned().position;
  setting.position = position == 0 ? 1 : position;
  setting.stations = setting.position;
  const std::string& file = run.setup().network_file;
  if (!file.empty()) setting.network = NetworkDescription::load(file);
}

// A case for a slave judges one; a second one would stand in the ring and never be looked at.
void expect_one_slave(const SlaveCase& slave_case, const SlaveSetting& setting, const RunningCase& run) {
  const auto count = std::ranges::count_if(run.setup().implementations, [](const Assignment& one) {
    return one.role.empty() || one.role == "slave";
  });
  if (count > 1) {
    refuse(
        fmt::format("the cases for a slave judge one slave, {} are given; leave one of them, or select the "
                    "cases for a network ('interbus/network/**')",
                    count));
  }
  slave_network(slave_case.needs, setting);
}

// As the bench's own network has it.
judge::Pics declared_usual_slave() {
  interbus::SlaveConfiguration usual;
  usual.id_code = 0x0203;
  usual.words = 2;
  return declared_slave(usual);
}

RoleRow slave_row() {
  return row_of<interbus::SlaveRole, interbus::Slave>(
      kSlaves,
      CaseRole<SlaveCase, SlaveSetting, CycleDissector>{
          .name = "slave",
          .cases = slave_cases,
          .adjust = put_at_position,
          .check = expect_one_slave,
          .run = run_slave_case,
          .declared_pics = [](const SlaveCase& one,
                              const SlaveSetting& setting) { return SlaveBench(one.needs, setting).pics(); },
          .pics_items = slave_pics_items,
          .usual_answers = declared_usual_slave,
          .settings = &interbus::kSlaveTable,
          .sequences =
              SequenceRow<SlaveCase>{slave_sequence_role, run_slave_sequence, slave_sequence_needs()}});
}

// ---- master ----

void expect_nothing_else(const MasterCase&, const MasterSetting&, const RunningCase& run) {
  if (!run.setup().network_file.empty())
    refuse("cases for a master make the rings that they need; leave out the network");
  if (!run.plan().empty()) refuse("cases for a master bring their own faults; leave out the plan");
}

RoleRow master_row() {
  return row_of<interbus::MasterRole, interbus::Master>(
      kMasters, CaseRole<MasterCase, MasterSetting, CycleDissector>{
                    .name = "master",
                    .cases = master_cases,
                    .check = expect_nothing_else,
                    .pics_items = master_pics_items,
                    .usual_answers = declared_master,
                    .settings = &interbus::kMasterTable,
                    .sequences = SequenceRow<MasterCase>{master_sequence_role, run_master_sequence}});
}

// ---- network ----

// A coupler with an input and an output terminal after it, and a station of two words: the least network
// that has everything.
NetworkDescription small_network() {
  using interbus::StationDescription;
  NetworkDescription network;
  network.name = "coupler, two terminals, station of two words";
  StationDescription coupler{
      .name = "coupler", .id_code = 0x0008, .cable_m = 0, .is_local = false, .branch = {}};
  coupler.branch.push_back(
      {.name = "inputs", .id_code = 0x01BE, .cable_m = 0, .is_local = true, .branch = {}});
  coupler.branch.push_back(
      {.name = "outputs", .id_code = 0x01BD, .cable_m = 0, .is_local = true, .branch = {}});
  network.stations.push_back(coupler);
  network.stations.push_back(
      {.name = "station", .id_code = 0x0203, .cable_m = 0, .is_local = false, .branch = {}});
  network.copy.push_back({.from = "inputs", .input_word = 0, .to = "outputs", .output_word = 0});
  return network;
}

// Each slave is one of its own, also of an implementation outside.
NetworkParts parts_of(RunningCase& run, std::size_t stations) {
  using MakeSlave = SlaveSetting::Make;
  NetworkParts parts;
  std::map<int, MakeSlave> slaves;
  for (const Assignment& one : run.setup().implementations) {
    if (one.uri == kReferenceUri) continue;
    if (one.role == "slave") {
      slaves[std::max(one.position, 1)] =
          run.maker<interbus::SlaveRole, interbus::Slave>(one.uri, slave_mutants(), kSlaves.what);
    } else if (one.role == "master") {
      parts.make_master =
          run.maker<interbus::MasterRole, interbus::Master>(one.uri, master_mutants(), kMasters.what);
    } else {
      parts = network_mutants().make(mutant_of(one.uri, "INTERBUS network"), stations);
    }
  }
  if (slaves.empty()) return parts;
  const int last = slaves.rbegin()->first;
  if (last > static_cast<int>(stations))
    refuse(fmt::format("there is no slave at position {}; the network has {}", last, stations));
  parts.make_slave = [slaves](int position, const interbus::SlaveConfiguration& configuration) {
    const auto assigned = slaves.find(position);
    return assigned == slaves.end() ? nullptr : assigned->second(configuration);
  };
  return parts;
}

void build_network(NetworkSetting& setting, RunningCase& run) {
  const std::string& file = run.setup().network_file;
  setting.network = file.empty() ? small_network() : NetworkDescription::load(file);
  setting.parts = parts_of(run, interbus::ring_order(setting.network).size());
}

RoleRow network_row() {
  RoleRow row = row_of(CaseRole<NetworkCase, NetworkSetting, CycleDissector>{
      .name = "network", .cases = network_cases, .adjust = build_network});
  row.mutants = network_mutants().mutants();
  return row;
}

const line::TelegramCode* telegrams(const std::string& network_file) {
  const interbus::Rules rules =
      network_file.empty() ? interbus::Rules{} : NetworkDescription::load(network_file).rules;
  return &line::shared_telegram_code(rules.telegram);
}

}  // namespace

std::unique_ptr<Suite> interbus_suite(SuiteGiven given) {
  return std::make_unique<Suite>(SuiteRows{.protocol = "interbus",
                                           .roles = {slave_row(), master_row(), network_row()},
                                           .rules = {{"rules", &interbus::kRulesTable}},
                                           .schemas = {{"network", interbus::network_schema}},
                                           .telegrams = telegrams,
                                           .last_position = static_cast<int>(interbus::Rules{}.max_stations)},
                                 std::move(given));
}

}  // namespace fieldproof::conformance
