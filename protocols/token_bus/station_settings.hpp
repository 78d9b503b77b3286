#pragma once

#include "harness/field/settings.hpp"
#include "harness/iut/device.hpp"
#include "protocols/token_bus/device.hpp"

// What an implementation outside is given of the configuration of a station.
namespace fieldproof::token_bus {

extern const field::Table<StationConfiguration> kStationTable;

field::Settings station_settings(const StationConfiguration& configuration);
StationConfiguration station_configuration_of(const iut::CaseBegin& begin);

}  // namespace fieldproof::token_bus
