#include "conformance/fieldbus_dll/suite.hpp"

#include "conformance/bench_role.hpp"
#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_las_sequence.hpp"
#include "conformance/fieldbus_dll/ff_mutants.hpp"
#include "conformance/fieldbus_dll/ff_sequence.hpp"
#include "conformance/fieldbus_dll/ff_standby.hpp"
#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_las_sequence.hpp"
#include "conformance/fieldbus_dll/isa_mutants.hpp"
#include "conformance/fieldbus_dll/isa_sequence_check.hpp"
#include "conformance/fieldbus_dll/isa_standby.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/fieldbus_dll/embedded_schemas.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"
#include "protocols/fieldbus_dll/ff_settings.hpp"
#include "protocols/fieldbus_dll/isa_las.hpp"
#include "protocols/fieldbus_dll/isa_settings.hpp"
#include "protocols/fieldbus_dll/link_dissector.hpp"
#include "protocols/fieldbus_dll/rule_tables.hpp"

namespace fieldproof::conformance {
namespace {

using namespace fieldbus_dll;

using FfCases = CaseRole<FfCase, FfSetting, LinkDissector>;
using IsaCases = CaseRole<IsaCase, IsaSetting, LinkDissector>;

constexpr std::string_view kIsaStation = "station of the profile ISA-D";
constexpr std::string_view kFfStation = "station of the profile FF-P";

RoleRow isa_dle_row() {
  return row_of<IsaDleRole, IsaDle>(
      {.what = kIsaStation, .mutants = isa_dle_mutants},
      IsaCases{.name = "isa_dle",
               .cases = isa_cases,
               .adjust = [](IsaSetting& setting, RunningCase&) { setting.address = kIsaStationAddress; },
               .settings = &kIsaTable,
               .sequences = SequenceRow<IsaCase>{isa_dle_sequence_role, run_isa_dle_sequence}});
}

RoleRow isa_las_row() {
  return row_of<IsaLasRole, IsaLas>(
      {.what = kIsaStation, .mutants = isa_las_mutants},
      IsaCases{.name = "isa_las",
               .cases = isa_cases,
               .adjust = [](IsaSetting& setting, RunningCase&) { setting.address = 0x10; },
               .settings = &kIsaTable,
               .sequences = SequenceRow<IsaCase>{isa_las_sequence_role, run_isa_las_sequence,
                                                 isa_las_sequence_needs()},
               .more_sequences = SequenceRow<IsaCase>{isa_standby_sequence_role, run_isa_dle_sequence,
                                                      isa_standby_sequence_needs()}});
}

RoleRow ff_device_row() {
  return row_of<FfDeviceRole, FfStation>(
      {.what = kFfStation, .mutants = ff_device_mutants},
      FfCases{.name = "ff_device",
              .cases = ff_cases,
              .settings = &kFfTable,
              .sequences = SequenceRow<FfCase>{ff_device_sequence_role, run_ff_device_sequence,
                                               ff_device_sequence_needs()}});
}

RoleRow ff_las_row() {
  return row_of<FfLasRole, FfLas>(
      {.what = kFfStation, .mutants = ff_las_mutants},
      FfCases{.name = "ff_las",
              .cases = ff_cases,
              .adjust = [](FfSetting& setting, RunningCase&) { setting.is_link_master = true; },
              .settings = &kFfTable,
              .sequences =
                  SequenceRow<FfCase>{ff_las_sequence_role, run_ff_las_sequence, ff_las_sequence_needs()},
              .more_sequences = SequenceRow<FfCase>{ff_standby_sequence_role, run_ff_device_sequence,
                                                    ff_standby_sequence_needs()}});
}

}  // namespace

std::unique_ptr<Suite> fieldbus_dll_suite(SuiteGiven given) {
  return std::make_unique<Suite>(
      SuiteRows{
          .protocol = "fieldbus_dll",
          .roles = {isa_dle_row(), isa_las_row(), ff_device_row(), ff_las_row()},
          .rules = {{"ff_rules", &kFfRulesTable}, {"isa_rules", &kIsaRulesTable}},
          .schemas = {{"network", link_network_schema}},
          .why_no_network = "cases of the data link make the link that they need; leave out the network"},
      std::move(given));
}

}  // namespace fieldproof::conformance
