#include "protocols/token_bus/station_settings.hpp"

#include "protocols/token_bus/rules_table.hpp"

namespace fieldproof::token_bus {
namespace {

using field::part;
using field::row;

constexpr field::Range kAddresses{0, 0xFFFF'FFFF'FFFF};

constexpr auto kRows = field::rows<StationConfiguration>(
    part<&StationConfiguration::rules>(kRulesTable),
    row<&StationConfiguration::address>(
        {field::kHexadecimal, kAddresses, "of the station, its first bit on the line lowest", kSourceOwn}),
    row<&StationConfiguration::in_ring_desired>(
        {{}, {}, "the station joins the ring from the start, not only to send", kSourceOwn}));

}  // namespace

constexpr field::Table<StationConfiguration> kStationTable = field::table<StationConfiguration>(kRows);

field::Settings station_settings(const StationConfiguration& configuration) {
  return field::settings_of(kStationTable, configuration);
}

StationConfiguration station_configuration_of(const iut::CaseBegin& begin) {
  return field::taken_from(kStationTable, begin.settings);
}

}  // namespace fieldproof::token_bus
