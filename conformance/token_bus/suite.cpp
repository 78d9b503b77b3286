#include "conformance/token_bus/suite.hpp"

#include "conformance/bench_role.hpp"
#include "conformance/token_bus/dual_channel_row.hpp"
#include "conformance/token_bus/station_cases.hpp"
#include "conformance/token_bus/station_mutants.hpp"
#include "conformance/token_bus/station_sequence.hpp"
#include "conformance/token_bus/translator_row.hpp"
#include "protocols/token_bus/attached_station.hpp"
#include "protocols/token_bus/dissector.hpp"
#include "protocols/token_bus/embedded_schemas.hpp"
#include "protocols/token_bus/rules_table.hpp"
#include "protocols/token_bus/station_settings.hpp"
#include "protocols/token_bus/token_station.hpp"

namespace fieldproof::conformance {
namespace {

RoleRow token_station_row() {
  using Cases = CaseRole<TokenCase, TokenSetting, token_bus::BusDissector>;
  return row_of<token_bus::StationRole, token_bus::TokenStation>(
      {.what = "station of the token bus", .mutants = token_station_mutants},
      Cases{.name = "station",
            .cases = token_cases,
            .settings = &token_bus::kStationTable,
            .sequences = SequenceRow<TokenCase>{token_station_sequence_role, run_token_station_sequence}});
}

}  // namespace

std::unique_ptr<Suite> token_bus_suite(SuiteGiven given) {
  return std::make_unique<Suite>(
      SuiteRows{
          .protocol = "token_bus",
          .roles = {token_station_row(), translator_row(), channel_manager_row()},
          .rules = {{"rules", &token_bus::kRulesTable}},
          .schemas = {{"network", token_bus::ring_network_schema}},
          .why_no_network = "cases of the token bus make the ring that they need; leave out the network"},
      std::move(given));
}

}  // namespace fieldproof::conformance
