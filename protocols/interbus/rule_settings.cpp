#include "protocols/interbus/rule_settings.hpp"

#include <algorithm>
#include <array>

#include "harness/iut/attached_case.hpp"
#include "harness/kernel/error.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::interbus {
namespace {

// Of a rule that is told: its name and where it stands.
template <typename Number>
struct SettingField {
  const char* name;
  Number Rules::* member;
};

constexpr std::array kWords{
    SettingField<std::uint16_t>{"status_clean", &Rules::status_clean},
    SettingField<std::uint16_t>{"status_marked", &Rules::status_marked},
    SettingField<std::uint16_t>{"control_remote_off", &Rules::control_remote_off},
    SettingField<std::uint16_t>{"control_local_off", &Rules::control_local_off},
    SettingField<std::uint16_t>{"control_reset", &Rules::control_reset},
    SettingField<std::uint16_t>{"control_acknowledge", &Rules::control_acknowledge},
    SettingField<std::uint16_t>{"message_reconfiguration", &Rules::message_reconfiguration},
    SettingField<std::uint16_t>{"message_check_error", &Rules::message_check_error},
    SettingField<std::uint16_t>{"message_peripheral_fault", &Rules::message_peripheral_fault},
};
constexpr std::array kDelays{
    SettingField<unsigned>{"forward_delay_half_bits", &Rules::forward_delay_half_bits},
    SettingField<unsigned>{"return_delay_half_bits", &Rules::return_delay_half_bits},
};
constexpr std::array kTimes{
    SettingField<kernel::Duration>{"silence_limit_ns", &Rules::silence_limit},
    SettingField<kernel::Duration>{"silence_tolerance_ns", &Rules::silence_tolerance},
};

// "check_polynomial" ...: a name would be of use to nobody who has no catalogue.
void tell_frame_check(const std::string& name, Settings& settings) {
  const line::FrameCheckParameters& check = line::frame_check_named(name);
  settings.emplace_back("check_polynomial", static_cast<std::int64_t>(check.poly));
  settings.emplace_back("check_preset", static_cast<std::int64_t>(check.init));
  settings.emplace_back("check_final_xor", static_cast<std::int64_t>(check.xorout));
  settings.emplace_back("check_is_reflected", check.refin ? 1 : 0);
}

std::string frame_check_of(const iut::CaseBegin& begin, const std::string& absent) {
  Settings settings;
  tell_frame_check(absent, settings);
  for (auto& [name, value] : settings) value = iut::setting(begin, name, value);
  for (const line::FrameCheckParameters& check : line::frame_check_catalogue()) {
    if (check.width != 16) continue;
    Settings candidate;
    tell_frame_check(std::string(check.name), candidate);
    if (candidate == settings) return std::string(check.name);
  }
  throw kernel::Error(kernel::ErrorKind::implementation, "the bench tells a frame check that nobody knows");
}

// Places of the header levels behind the start level, and the levels that mean "set".
void tell_telegram(const line::TelegramLayout& layout, Settings& settings) {
  const auto place_of = [&](line::HeaderLevel level) {
    return std::ranges::find(layout.header, level) - layout.header.begin();
  };
  settings.emplace_back("select_place", place_of(line::HeaderLevel::select));
  settings.emplace_back("control_place", place_of(line::HeaderLevel::control));
  settings.emplace_back("flag_place", place_of(line::HeaderLevel::flag));
  settings.emplace_back("select_level", layout.select_level ? 1 : 0);
  settings.emplace_back("control_level", layout.control_level ? 1 : 0);
  settings.emplace_back("data_flag_level", layout.data_flag_level ? 1 : 0);
  settings.emplace_back("most_significant_first", layout.most_significant_first ? 1 : 0);
}

line::TelegramLayout telegram_of(const iut::CaseBegin& begin) {
  line::TelegramLayout layout;
  const auto put = [&](std::string_view name, line::HeaderLevel level, std::int64_t absent) {
    const std::int64_t place = iut::setting(begin, name, absent);
    layout.header.at(static_cast<std::size_t>(std::clamp<std::int64_t>(place, 0, 2))) = level;
  };
  put("select_place", line::HeaderLevel::select, 0);
  put("control_place", line::HeaderLevel::control, 1);
  put("flag_place", line::HeaderLevel::flag, 2);
  layout.select_level = iut::setting(begin, "select_level", 1) != 0;
  layout.control_level = iut::setting(begin, "control_level", 1) != 0;
  layout.data_flag_level = iut::setting(begin, "data_flag_level", 1) != 0;
  layout.most_significant_first = iut::setting(begin, "most_significant_first", 1) != 0;
  return layout;
}

}  // namespace

std::int64_t setting_within(const iut::CaseBegin& begin, std::string_view name, std::int64_t absent,
                            std::int64_t most) {
  return std::clamp<std::int64_t>(iut::setting(begin, name, absent), 0, most);
}

void tell_rules(const Rules& rules, Settings& settings) {
  settings.emplace_back("bit_rate", rules.bit_rate);
  for (const auto& [name, member] : kDelays) settings.emplace_back(name, rules.*member);
  for (const auto& [name, member] : kWords) settings.emplace_back(name, rules.*member);
  for (const auto& [name, member] : kTimes) settings.emplace_back(name, rules.*member / kernel::kNanosecond);
  tell_frame_check(rules.frame_check, settings);
  tell_telegram(rules.telegram, settings);
}

void read_rules(const iut::CaseBegin& begin, Rules& rules) {
  rules.bit_rate = std::max<std::int64_t>(1, setting_within(begin, "bit_rate", rules.bit_rate, 100'000'000));
  for (const auto& [name, member] : kDelays) {
    rules.*member = static_cast<unsigned>(setting_within(begin, name, rules.*member, 1'000));
  }
  for (const auto& [name, member] : kWords) {
    rules.*member = static_cast<std::uint16_t>(setting_within(begin, name, rules.*member, 0xFFFF));
  }
  constexpr std::int64_t kAnHour = 3'600'000'000'000;
  for (const auto& [name, member] : kTimes) {
    rules.*member =
        setting_within(begin, name, rules.*member / kernel::kNanosecond, kAnHour) * kernel::kNanosecond;
  }
  rules.frame_check = frame_check_of(begin, rules.frame_check);
  rules.telegram = telegram_of(begin);
}

}  // namespace fieldproof::interbus
