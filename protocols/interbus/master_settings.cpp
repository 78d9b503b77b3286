#include "protocols/interbus/master_settings.hpp"

#include <array>

#include "protocols/interbus/rules.hpp"

namespace fieldproof::interbus {
namespace {

using field::row;

constexpr std::string_view kOwn = "this project's choice";
constexpr std::int64_t kMostPackedStation = (std::int64_t{1} << 49) - 1;
constexpr std::int64_t kMostPackedCopy = (std::int64_t{1} << 32) - 1;

std::uint64_t packed_copy(const MasterConfiguration::Copy& copy) {
  return (copy.input_word & 0xFFFFU) | std::uint64_t{copy.output_word & 0xFFFFU} << 16;
}

MasterConfiguration::Copy copy_of(std::uint64_t value) {
  return {static_cast<unsigned>(value & 0xFFFF), static_cast<unsigned>(value >> 16 & 0xFFFF)};
}

constexpr auto kGiven =
    field::kNames<&Rules::bit_rate, &Rules::telegram, &Rules::telegram_gap_millibits,
                  &Rules::status_pitch_bits, &Rules::forward_delay_half_bits, &Rules::return_delay_half_bits,
                  &Rules::cable_delay_ps_per_m, &Rules::loopback_word, &Rules::frame_check,
                  &Rules::status_clean, &Rules::status_marked, &Rules::end_telegrams, &Rules::software_time,
                  &Rules::silence_limit, &Rules::silence_tolerance, &Rules::stop_after_bad_cycles,
                  &Rules::quality_bad_cycles, &Rules::quality_window_cycles, &Rules::max_stations,
                  &Rules::max_io_points, &Rules::max_levels, &Rules::max_cable_m, &Rules::control_remote_off,
                  &Rules::control_local_off, &Rules::control_reset, &Rules::control_acknowledge,
                  &Rules::message_reconfiguration, &Rules::message_check_error,
                  &Rules::message_peripheral_fault, &Rules::length_codes>;

constexpr std::array kStationRow{field::packed_item<FoundStation, packed_station, found_station_of>(
    {field::kHexadecimal,
     {0, kMostPackedStation},
     "ID code | words << 16 | (number of the station before it + 1) << 32 | on its branch << 48",
     kOwn})};
constexpr field::Table<FoundStation> kStationTable = field::table<FoundStation>(kStationRow);
constexpr std::array kCopyRow{field::packed_item<MasterConfiguration::Copy, packed_copy, copy_of>(
    {field::kHexadecimal, {0, kMostPackedCopy}, "input word | output word << 16", kOwn})};
constexpr field::Table<MasterConfiguration::Copy> kCopyTable =
    field::table<MasterConfiguration::Copy>(kCopyRow);

constexpr auto kRows = field::rows<MasterConfiguration>(
    row<&MasterConfiguration::cycle_time>({field::kTime, field::between({}, kLongestCycle),
                                           "the cycle time that is requested, 0 for the shortest", kOwn}),
    field::part<&MasterConfiguration::rules>(kRulesTable, kGiven),
    field::list<&MasterConfiguration::expected>(
        kStationTable, kMostMasterWords,
        {{}, {}, "stations that must be found, in the order of the ring; 0: what is found is taken", kOwn}),
    field::list<&MasterConfiguration::copy>(
        kCopyTable, kMostMasterWords,
        {{}, {}, "words that are copied after each accepted data cycle", kOwn}));

}  // namespace

constexpr field::Table<MasterConfiguration> kMasterTable = field::table<MasterConfiguration>(kRows);

field::Settings master_settings(const MasterConfiguration& configuration) {
  return field::settings_of(kMasterTable, configuration);
}

MasterConfiguration master_configuration_of(const iut::CaseBegin& begin) {
  return field::taken_from(kMasterTable, begin.settings);
}

std::uint64_t packed_station(const FoundStation& station) {
  return station.id_code | std::uint64_t{station.words & 0xFFFF} << 16 |
         (static_cast<std::uint64_t>(station.before + 1) & 0xFFFF) << 32 |
         (station.on_branch ? std::uint64_t{1} << 48 : 0);
}

FoundStation found_station_of(std::uint64_t value) {
  return {static_cast<std::uint16_t>(value), static_cast<unsigned>(value >> 16 & 0xFFFF),
          static_cast<int>(value >> 32 & 0xFFFF) - 1, (value >> 48 & 1) != 0};
}

}  // namespace fieldproof::interbus
