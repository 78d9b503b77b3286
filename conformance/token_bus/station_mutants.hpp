#pragma once

#include "conformance/mutant_table.hpp"
#include "protocols/token_bus/device.hpp"

namespace fieldproof::conformance {

using TokenMutants = DeviceMutants<token_bus::StationDevice, token_bus::StationConfiguration>;

// Stations of the token bus with one seeded fault each.
const TokenMutants& token_station_mutants();

}  // namespace fieldproof::conformance
