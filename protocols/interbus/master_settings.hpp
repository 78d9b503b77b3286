#pragma once

#include "harness/field/settings.hpp"
#include "harness/iut/device.hpp"
#include "protocols/interbus/device.hpp"

// What a master is given at the beginning of a case.
namespace fieldproof::interbus {

// How many words, and stations, a master may have.
inline constexpr unsigned kMostMasterWords = 0x1000;
inline constexpr kernel::Duration kLongestCycle = 3'600 * kernel::kSecond;

extern const field::Table<MasterConfiguration> kMasterTable;

field::Settings master_settings(const MasterConfiguration& configuration);
// Throws kernel::Error for a frame check that no catalogue has.
MasterConfiguration master_configuration_of(const iut::CaseBegin& begin);

// ID code | words << 16 | (before + 1) << 32 | on branch << 48.
std::uint64_t packed_station(const FoundStation& station);
FoundStation found_station_of(std::uint64_t value);

}  // namespace fieldproof::interbus
