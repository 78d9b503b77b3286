#include "conformance/interbus/slave_codings.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "harness/field/walk.hpp"
#include "protocols/interbus/slave_settings.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::array<std::string_view, 3> kPlacesOfLevels{"select_place", "control_place", "flag_place"};
constexpr std::array<std::string_view, 4> kOrderPlaces{"control_remote_off", "control_local_off",
                                                       "control_reset", "control_acknowledge"};
constexpr std::array<std::string_view, 3> kMessagePlaces{"message_reconfiguration", "message_check_error",
                                                         "message_peripheral_fault"};

// The values of one that may be drawn, its usual one among them.
struct Coding {
  std::string_view name;
  std::string_view row;  // of the table
  std::span<const std::int64_t> values;
};

constexpr std::array<std::int64_t, 3> kPlaces{0, 1, 2};
constexpr std::array<std::int64_t, 2> kTruths{0, 1};
constexpr std::array<std::int64_t, 7> kBits{0x0001, 0x0002, 0x0004, 0x0008, 0x0080, 0x0100, 0x8000};
constexpr std::array<std::int64_t, 3> kMessageBits{0x2000, 0x4000, 0x8000};
// No mark lies within a clean word.
constexpr std::array<std::int64_t, 3> kClean{0x0000, 0x0A50, 0x00FF};
constexpr std::array<std::int64_t, 3> kMarked{0xFFFF, 0x8100, 0x1800};

constexpr auto kCodings =
    std::to_array<Coding>({{"select_place", "telegram", kPlaces},
                           {"control_place", "telegram", kPlaces},
                           {"flag_place", "telegram", kPlaces},
                           {"select_level", "telegram", kTruths},
                           {"control_level", "telegram", kTruths},
                           {"data_flag_level", "telegram", kTruths},
                           {"most_significant_first", "telegram", kTruths},
                           {"status_clean", "status_clean", kClean},
                           {"status_marked", "status_marked", kMarked},
                           {"control_remote_off", "control_remote_off", kBits},
                           {"control_local_off", "control_local_off", kBits},
                           {"control_reset", "control_reset", kBits},
                           {"control_acknowledge", "control_acknowledge", kBits},
                           {"message_reconfiguration", "message_reconfiguration", kMessageBits},
                           {"message_check_error", "message_check_error", kMessageBits},
                           {"message_peripheral_fault", "message_peripheral_fault", kMessageBits}});

std::int64_t& value_of(field::Settings& settings, std::string_view name) {
  return std::ranges::find(settings, name, &field::Settings::value_type::first)->second;
}

std::span<const std::string_view> those_beside(std::string_view name) {
  for (const std::span<const std::string_view> group :
       {std::span<const std::string_view>(kPlacesOfLevels), std::span<const std::string_view>(kOrderPlaces),
        std::span<const std::string_view>(kMessagePlaces)}) {
    if (std::ranges::find(group, name) != group.end()) return group;
  }
  return {};
}

}  // namespace

std::vector<SequenceSetting> settings_of_codings(const interbus::SlaveConfiguration& as_made) {
  field::Settings usual = field::settings_of(interbus::kSlaveTable, as_made);
  std::vector<SequenceSetting> all;
  field::walk(interbus::kSlaveTable, &as_made, [&](const field::Leaf& leaf) {
    for (const Coding& coding : kCodings) {
      if (coding.row != leaf.name) continue;
      SequenceSetting setting{.name = std::string(coding.name),
                              .row = &leaf.row,
                              .least = coding.values.front(),
                              .most = std::ranges::max(coding.values),
                              .simple = value_of(usual, coding.name),
                              .likely = {coding.values.begin(), coding.values.end()},
                              .is_likely_only = true};
      setting.least = std::ranges::min(coding.values);
      std::erase(setting.likely, setting.simple);
      all.push_back(std::move(setting));
    }
  });
  return all;
}

field::Settings with_changed_places(const field::Settings& given,
                                    const interbus::SlaveConfiguration& as_made) {
  const field::Settings before = field::settings_of(interbus::kSlaveTable, as_made);
  field::Settings after = before;
  field::Settings all;
  for (const auto& [name, value] : given) {
    const std::span<const std::string_view> group = those_beside(name);
    if (group.empty()) {
      all.emplace_back(name, value);
      continue;
    }
    for (const std::string_view other : group)
      if (value_of(after, other) == value) value_of(after, other) = value_of(after, name);
    value_of(after, name) = value;
  }
  for (std::size_t n = 0; n < after.size(); ++n)
    if (after[n] != before[n]) all.push_back(after[n]);
  return all;
}

}  // namespace fieldproof::conformance
