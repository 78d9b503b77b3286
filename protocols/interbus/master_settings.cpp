// What a master is told of its case, and how it is read back.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "protocols/interbus/attached_master.hpp"

namespace fieldproof::interbus {
namespace {

// Of a number that is told: its name, where it stands, and its range.
struct ToldNumber {
  const char* name;
  unsigned Rules::* member;
  std::int64_t least;
  std::int64_t most;
};

constexpr std::array kNumbers{
    ToldNumber{"telegram_gap_millibits", &Rules::telegram_gap_millibits, 0, 1'000'000},
    ToldNumber{"status_pitch_bits", &Rules::status_pitch_bits, 5, 1'000},
    ToldNumber{"end_telegrams", &Rules::end_telegrams, 0, 1'000},
    ToldNumber{"stop_after_bad_cycles", &Rules::stop_after_bad_cycles, 1, 1'000'000},
    ToldNumber{"quality_bad_cycles", &Rules::quality_bad_cycles, 1, 1'000'000},
    ToldNumber{"quality_window_cycles", &Rules::quality_window_cycles, 1, 1'000'000'000},
    // As many as there are items.
    ToldNumber{"max_stations", &Rules::max_stations, 0, kMostMasterWords},
    ToldNumber{"max_io_points", &Rules::max_io_points, 0, 16 * kMostMasterWords},
    ToldNumber{"max_levels", &Rules::max_levels, 0, 1'000},
    ToldNumber{"max_cable_m", &Rules::max_cable_m, 0, 1'000'000},
};

constexpr unsigned kLengthCodes = 32;

std::string numbered(std::string_view name, std::size_t n) {
  return fmt::format("{}_{}", name, n);
}

// What stands in a list: how many, then each by its number.
template <typename Items, typename Pack>
void tell_list(std::string_view count, std::string_view name, const Items& items, Pack pack,
               Settings& settings) {
  settings.emplace_back(count, static_cast<std::int64_t>(items.size()));
  for (std::size_t n = 0; n < items.size(); ++n) settings.emplace_back(numbered(name, n), pack(items[n]));
}

template <typename Item, typename Unpack>
std::vector<Item> list_of(const iut::CaseBegin& begin, std::string_view count, std::string_view name,
                          Unpack unpack) {
  std::vector<Item> items;
  const std::int64_t size = setting_within(begin, count, 0, kMostMasterWords);
  for (std::int64_t n = 0; n < size; ++n) {
    const std::int64_t value = iut::setting(begin, numbered(name, static_cast<std::size_t>(n)), 0);
    items.push_back(unpack(static_cast<std::uint64_t>(value)));
  }
  return items;
}

std::vector<LengthCode> told_length_codes(const iut::CaseBegin& begin) {
  std::vector<LengthCode> codes;
  for (unsigned code = 0; code < kLengthCodes; ++code) {
    const std::int64_t words = iut::setting(begin, numbered("words_of_length_code", code), -1);
    if (words < 0) continue;
    codes.push_back(
        {static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(std::min<std::int64_t>(words, 0xFF))});
  }
  return codes;
}

std::uint64_t packed_copy(const MasterConfiguration::Copy& copy) {
  return (copy.input_word & 0xFFFFU) | std::uint64_t{copy.output_word & 0xFFFFU} << 16;
}

MasterConfiguration::Copy copy_of(std::uint64_t value) {
  return {static_cast<unsigned>(value & 0xFFFF), static_cast<unsigned>(value >> 16 & 0xFFFF)};
}

}  // namespace

// Where a slave is told nanoseconds these are picoseconds, because the cycle time is made of them.
Settings master_settings(const MasterConfiguration& configuration) {
  const Rules& rules = configuration.rules;
  Settings settings{{"cycle_time_ps", configuration.cycle_time.count()},
                    {"software_time_ps", rules.software_time.count()},
                    {"cable_delay_ps_per_m", rules.cable_delay_ps_per_m},
                    {"loopback_word", rules.loopback_word}};
  for (const ToldNumber& one : kNumbers) settings.emplace_back(one.name, rules.*one.member);
  tell_rules(rules, settings);
  for (const LengthCode& one : length_codes_of(rules)) {
    settings.emplace_back(numbered("words_of_length_code", one.code), one.words);
  }
  tell_list(
      "expected_stations", "expected_station", configuration.expected,
      [](const FoundStation& one) { return static_cast<std::int64_t>(packed_station(one)); }, settings);
  tell_list(
      "copies", "copy", configuration.copy,
      [](const auto& one) { return static_cast<std::int64_t>(packed_copy(one)); }, settings);
  return settings;
}

MasterConfiguration master_configuration_of(const iut::CaseBegin& begin) {
  MasterConfiguration configuration;
  Rules& rules = configuration.rules;
  const auto span = [&](std::string_view name, kernel::Duration absent) {
    return kernel::Duration{setting_within(begin, name, absent.count(), kLongestCycle.count())};
  };
  configuration.cycle_time = span("cycle_time_ps", {});
  rules.software_time = span("software_time_ps", rules.software_time);
  rules.cable_delay_ps_per_m =
      setting_within(begin, "cable_delay_ps_per_m", rules.cable_delay_ps_per_m, 1'000'000);
  rules.loopback_word =
      static_cast<std::uint16_t>(setting_within(begin, "loopback_word", rules.loopback_word, 0xFFFF));
  for (const ToldNumber& one : kNumbers) {
    const std::int64_t told = setting_within(begin, one.name, rules.*one.member, one.most);
    rules.*one.member = static_cast<unsigned>(std::max(told, one.least));
  }
  read_rules(begin, rules);
  rules.length_codes = told_length_codes(begin);
  configuration.expected =
      list_of<FoundStation>(begin, "expected_stations", "expected_station", found_station_of);
  configuration.copy = list_of<MasterConfiguration::Copy>(begin, "copies", "copy", copy_of);
  return configuration;
}

}  // namespace fieldproof::interbus
