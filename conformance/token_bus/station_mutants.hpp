#pragma once

#include "conformance/mutant_table.hpp"
#include "protocols/token_bus/device.hpp"

namespace fieldproof::conformance {

using TokenMutants = DeviceMutants<token_bus::StationDevice, token_bus::StationConfiguration>;

// The groups that are not with the table.
std::vector<TokenMutants::Row> token_settings_rows();
std::vector<TokenMutants::Row> token_line_rows();
std::vector<TokenMutants::Row> token_host_rows();
std::vector<TokenMutants::Row> token_anew_rows();
std::vector<TokenMutants::Row> token_vocabulary_rows();
std::vector<TokenMutants::Row> token_partial_rows();
std::vector<TokenMutants::Row> token_each_rows();

// Stations of the token bus with one seeded fault each.
const TokenMutants& token_station_mutants();

}  // namespace fieldproof::conformance
