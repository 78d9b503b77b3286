#include "protocols/interbus/attached_slave.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/kernel/error.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::interbus {
namespace {

constexpr unsigned kMostSlaveWords = kInputWord - kOutputWord;

using Settings = std::vector<std::pair<std::string, std::int64_t>>;

// Of a rule that is told: its name and where it stands.
template <typename Number>
struct Told {
  const char* name;
  Number Rules::* member;
};

constexpr std::array kWords{
    Told<std::uint16_t>{"status_clean", &Rules::status_clean},
    Told<std::uint16_t>{"status_marked", &Rules::status_marked},
    Told<std::uint16_t>{"control_remote_off", &Rules::control_remote_off},
    Told<std::uint16_t>{"control_local_off", &Rules::control_local_off},
    Told<std::uint16_t>{"control_reset", &Rules::control_reset},
    Told<std::uint16_t>{"control_acknowledge", &Rules::control_acknowledge},
    Told<std::uint16_t>{"message_reconfiguration", &Rules::message_reconfiguration},
    Told<std::uint16_t>{"message_check_error", &Rules::message_check_error},
    Told<std::uint16_t>{"message_peripheral_fault", &Rules::message_peripheral_fault},
};
constexpr std::array kTimes{
    Told<kernel::Duration>{"silence_limit_ns", &Rules::silence_limit},
    Told<kernel::Duration>{"silence_tolerance_ns", &Rules::silence_tolerance},
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

Settings slave_settings(const SlaveConfiguration& configuration) {
  const Rules& rules = configuration.rules;
  const bool is_local = configuration.is_local;
  Settings settings{
      {"id_code", configuration.id_code},
      {"words", configuration.words},
      {"has_branch", configuration.has_branch ? 1 : 0},
      {"bit_rate", rules.bit_rate},
      {"forward_delay_half_bits", is_local ? rules.local_delay_half_bits : rules.forward_delay_half_bits},
      {"return_delay_half_bits", is_local ? rules.local_delay_half_bits : rules.return_delay_half_bits}};
  for (const auto& [name, member] : kWords) settings.emplace_back(name, rules.*member);
  for (const auto& [name, member] : kTimes) settings.emplace_back(name, rules.*member / kernel::kNanosecond);
  tell_frame_check(rules.frame_check, settings);
  tell_telegram(rules.telegram, settings);
  return settings;
}

SlaveConfiguration slave_configuration_of(const iut::CaseBegin& begin) {
  SlaveConfiguration configuration;
  Rules& rules = configuration.rules;
  const auto within = [&](std::string_view name, std::int64_t absent, std::int64_t most) {
    return std::clamp<std::int64_t>(iut::setting(begin, name, absent), 0, most);
  };
  configuration.id_code = static_cast<std::uint16_t>(within("id_code", 0, 0x1FFF));
  configuration.words = static_cast<unsigned>(within("words", 0, kMostSlaveWords));
  configuration.has_branch = within("has_branch", 0, 1) != 0;
  rules.bit_rate = std::max<std::int64_t>(1, within("bit_rate", rules.bit_rate, 100'000'000));
  rules.forward_delay_half_bits =
      static_cast<unsigned>(within("forward_delay_half_bits", rules.forward_delay_half_bits, 1'000));
  rules.return_delay_half_bits =
      static_cast<unsigned>(within("return_delay_half_bits", rules.return_delay_half_bits, 1'000));
  for (const auto& [name, member] : kWords) {
    rules.*member = static_cast<std::uint16_t>(within(name, rules.*member, 0xFFFF));
  }
  constexpr std::int64_t kAnHour = 3'600'000'000'000;
  for (const auto& [name, member] : kTimes) {
    rules.*member = within(name, rules.*member / kernel::kNanosecond, kAnHour) * kernel::kNanosecond;
  }
  rules.frame_check = frame_check_of(begin, rules.frame_check);
  rules.telegram = telegram_of(begin);
  return configuration;
}

AttachedSlave::AttachedSlave(iut::Attachment attachment, const SlaveConfiguration& configuration,
                             const std::string& case_id, std::uint64_t seed)
    : words_(configuration.words), attached_(std::move(attachment)) {
  if (!attached_.hears_levels()) {
    throw kernel::Error(kernel::ErrorKind::implementation,
                        "an INTERBUS slave hears and says levels; this implementation announces characters");
  }
  attached_.begin({case_id, seed, slave_settings(configuration)}, *this);
}

// A slave of the bench is supplied from the beginning.
void AttachedSlave::wire(const SlavePorts& ports, Terminals& terminals) {
  ports_ = {ports.upstream, ports.branch, ports.remote};
  terminals_ = &terminals;
  attached_.set_power(true, kernel::kStart);
}

void AttachedSlave::receive(segment::PortIndex port, const line::Waveform& reception) {
  attached_.call(reception.start, [&](iut::Device& device) { device.receive(port, reception); });
}

void AttachedSlave::transmit(const iut::Transmission&) {
  iut::refuse_impossible("sends characters; an INTERBUS slave says levels");
}

void AttachedSlave::transmit(unsigned port, line::Waveform& wave) {
  attached_.expect_drive(wave);
  if (port >= ports_.size() || ports_.at(port) == nullptr) {
    iut::refuse_impossible(fmt::format("drives port {}, where nothing is plugged in", port));
  }
  ports_.at(port)->drive(wave);
}

void AttachedSlave::write(iut::Item item, std::uint64_t value, kernel::Time when) {
  if (item - kOutputWord >= static_cast<int>(words_) || value > 0xFFFF) {
    iut::refuse_impossible(
        fmt::format("writes {} to item {}; this slave has {} output words, from item {} on", value, item,
                    words_, kOutputWord));
  }
  attached_.expect_in_order(when, "moves its outputs");
  terminals_->output(item - kOutputWord, static_cast<std::uint16_t>(value), when);
}

std::uint64_t AttachedSlave::read(iut::Item item, kernel::Time when) {
  attached_.expect_ahead(when, "looks at its terminals");
  if (item == kPeripheralFault) return terminals_->has_peripheral_fault(when) ? 1 : 0;
  if (item == kReconfiguration) return terminals_->wants_reconfiguration(when) ? 1 : 0;
  if (item == kRemotePlugged) return remote_present_ && ports_[kFromRemote] != nullptr ? 1 : 0;
  if (item == kBranchPlugged) return branch_present_ && ports_[kFromBranch] != nullptr ? 1 : 0;
  if (item < kInputWord || item >= kInputWord + words_) {
    iut::refuse_impossible(fmt::format("reads item {}; this slave has {} input words, from item {} on", item,
                                       words_, kInputWord));
  }
  return terminals_->input(item - kInputWord, when);
}

// ---- a slave of ours ----

bool ServedSlave::begin(const iut::CaseBegin& begin, iut::Bench& bench) {
  play(make_(slave_configuration_of(begin)), bench);
  return true;
}

// It has no switch of its own: with the supply it is there. Where nothing is plugged in then, nothing will
// be.
void ServedSlave::set_power(bool is_on, kernel::Time now) {
  if (!is_on) return;
  SlavePorts ports{.upstream = &port(kFromUpstream)};
  is_branch_plugged_ = bench().read(kBranchPlugged, now) != 0;
  is_remote_plugged_ = bench().read(kRemotePlugged, now) != 0;
  if (is_branch_plugged_) ports.branch = &port(kFromBranch);
  if (is_remote_plugged_) ports.remote = &port(kFromRemote);
  station().wire(ports, *this);
}

// A plug is put in or pulled between two calls.
void ServedSlave::before_call() {
  const auto follow = [&](iut::Item item, bool on_branch, bool& known) {
    const bool is_plugged = bench().read(item, now()) != 0;
    if (is_plugged == known) return;
    known = is_plugged;
    station().set_next_present(on_branch, is_plugged);
  };
  follow(kBranchPlugged, true, is_branch_plugged_);
  follow(kRemotePlugged, false, is_remote_plugged_);
}

std::uint16_t ServedSlave::input(unsigned word, kernel::Time when) {
  return static_cast<std::uint16_t>(bench().read(static_cast<iut::Item>(kInputWord + word), not_past(when)));
}

void ServedSlave::output(unsigned word, std::uint16_t value, kernel::Time when) {
  bench().write(static_cast<iut::Item>(kOutputWord + word), value, not_past(when));
}

bool ServedSlave::has_peripheral_fault(kernel::Time when) {
  return bench().read(kPeripheralFault, not_past(when)) != 0;
}

bool ServedSlave::wants_reconfiguration(kernel::Time when) {
  return bench().read(kReconfiguration, not_past(when)) != 0;
}

}  // namespace fieldproof::interbus
