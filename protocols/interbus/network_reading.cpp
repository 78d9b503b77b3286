// From a JSON document to a NetworkDescription: the shape that network.schema.json writes down, then `check`.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "harness/config/nearest.hpp"
#include "harness/line/frame_check.hpp"
#include "protocols/interbus/network.hpp"

namespace fieldproof::interbus {

namespace {

using config::ObjectReader;
using config::Value;

constexpr std::int64_t kSlowest = 1'000;        // bit/s
constexpr std::int64_t kFastest = 100'000'000;  // bit/s
constexpr std::int64_t kPublishedFastRate = 2'000'000;
constexpr unsigned kDistanceAtFastRate = 150;
constexpr unsigned kMostInteger = 1'000'000'000;

void set_count(ObjectReader& object, std::string_view key, unsigned& target, unsigned min = 0,
               unsigned max = kMostInteger) {
  if (const auto value = object.optional(key)) target = value->as_integer<unsigned>(min, max);
}

void set_word(ObjectReader& object, std::string_view key, std::uint16_t& target) {
  if (const auto value = object.optional(key)) target = value->as_hex_or_integer<std::uint16_t>();
}

void set_duration(ObjectReader& object, std::string_view key, kernel::Duration& target) {
  if (const auto value = object.optional(key)) {
    target = value->as_duration(kernel::Duration::zero(), 1000 * kernel::kSecond);
  }
}

void set_flag(ObjectReader& object, std::string_view key, bool& target) {
  if (const auto value = object.optional(key)) target = value->as_bool();
}

std::array<line::HeaderLevel, 3> read_header(const Value& value) {
  std::array<line::HeaderLevel, 3> header{};
  const auto names = value.as_array(header.size(), header.size());
  for (std::size_t n = 0; n < header.size(); ++n) {
    header[n] = names[n].as_choice<line::HeaderLevel>({{"select", line::HeaderLevel::select},
                                                       {"control", line::HeaderLevel::control},
                                                       {"flag", line::HeaderLevel::flag}});
    if (std::find(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(n), header[n]) !=
        header.begin() + static_cast<std::ptrdiff_t>(n)) {
      config::fail(names[n], "this header level is there already; write each of the three once");
    }
  }
  return header;
}

line::TelegramLayout read_telegram(const Value& value) {
  return config::read_object(value, [](ObjectReader& object) {
    line::TelegramLayout layout;
    if (const auto header = object.optional("header")) layout.header = read_header(*header);
    set_flag(object, "select_level", layout.select_level);
    set_flag(object, "control_level", layout.control_level);
    set_flag(object, "data_flag_level", layout.data_flag_level);
    set_flag(object, "most_significant_first", layout.most_significant_first);
    return layout;
  });
}

LengthCode read_length_code(const Value& value) {
  return config::read_object(value, [](ObjectReader& object) {
    LengthCode entry{};
    entry.code = object.required("code").as_hex_or_integer<std::uint8_t>(0x1F);
    entry.words = object.required("words").as_integer<std::uint8_t>(0, 255);
    return entry;
  });
}

std::vector<LengthCode> read_length_codes(const Value& value) {
  std::vector<LengthCode> table;
  for (const Value& element : value.as_array(1, 32)) {
    const LengthCode entry = read_length_code(element);
    if (std::any_of(table.begin(), table.end(), [&](const LengthCode& e) { return e.code == entry.code; })) {
      config::fail(element, fmt::format("length code {:02X}h is there already; write it once", entry.code));
    }
    table.push_back(entry);
  }
  return table;
}

std::string read_frame_check(const Value& value) {
  const std::string_view name = value.as_string();
  const line::FrameCheckParameters* parameters = line::find_frame_check(name);
  if (parameters == nullptr) {
    const auto names = line::frame_check_names();
    const auto near = config::nearest(name, names, 3);
    config::fail(value,
                 fmt::format("no frame check has this name; near to it are {}", fmt::join(near, ", ")));
  }
  if (parameters->width != 16 || parameters->refin != parameters->refout) {
    config::fail(value, fmt::format("{} does not fill the 16 bit of a check word; write for example "
                                    "\"CRC-16/IBM-3740\" or \"CRC-16/GENIBUS\"",
                                    parameters->name));
  }
  return std::string(parameters->name);
}

void read_line_rules(ObjectReader& object, Rules& rules) {
  if (const auto telegram = object.optional("telegram")) rules.telegram = read_telegram(*telegram);
  set_count(object, "telegram_gap_millibits", rules.telegram_gap_millibits, 0, 1'000'000);
  set_count(object, "status_pitch_bits", rules.status_pitch_bits, line::kStatusTelegramLevels, 1'000'000);
  set_count(object, "forward_delay_half_bits", rules.forward_delay_half_bits, 0, 1'000);
  set_count(object, "return_delay_half_bits", rules.return_delay_half_bits, 0, 1'000);
  set_count(object, "local_delay_half_bits", rules.local_delay_half_bits, 0, 1'000);
  if (const auto delay = object.optional("cable_delay_ps_per_m")) {
    rules.cable_delay_ps_per_m = delay->as_integer<std::int64_t>(0, 1'000'000);
  }
}

void read_cycle_rules(ObjectReader& object, Rules& rules) {
  set_word(object, "loopback_word", rules.loopback_word);
  if (const auto name = object.optional("frame_check")) rules.frame_check = read_frame_check(*name);
  set_word(object, "status_clean", rules.status_clean);
  set_word(object, "status_marked", rules.status_marked);
  set_count(object, "end_telegrams", rules.end_telegrams, 0, 1'000);
  set_duration(object, "software_time", rules.software_time);
}

void read_supervision_rules(ObjectReader& object, Rules& rules) {
  set_duration(object, "silence_limit", rules.silence_limit);
  set_duration(object, "silence_tolerance", rules.silence_tolerance);
  set_duration(object, "latch_limit", rules.latch_limit);
  set_count(object, "stop_after_bad_cycles", rules.stop_after_bad_cycles, 1);
  set_count(object, "quality_bad_cycles", rules.quality_bad_cycles, 1);
  set_count(object, "quality_window_cycles", rules.quality_window_cycles, 1);
  set_count(object, "published_recovery_cycles", rules.published_recovery_cycles, 1);
  set_count(object, "max_stations", rules.max_stations);
  set_count(object, "max_io_points", rules.max_io_points);
  set_count(object, "max_levels", rules.max_levels, 1, 30);
  set_count(object, "max_distance_m", rules.max_distance_m);
  set_count(object, "max_cable_m", rules.max_cable_m);
}

void read_word_rules(ObjectReader& object, Rules& rules) {
  set_word(object, "control_remote_off", rules.control_remote_off);
  set_word(object, "control_local_off", rules.control_local_off);
  set_word(object, "control_reset", rules.control_reset);
  set_word(object, "control_acknowledge", rules.control_acknowledge);
  set_word(object, "message_reconfiguration", rules.message_reconfiguration);
  set_word(object, "message_check_error", rules.message_check_error);
  set_word(object, "message_peripheral_fault", rules.message_peripheral_fault);
  if (const auto codes = object.optional("length_codes")) rules.length_codes = read_length_codes(*codes);
}

// A name that can stand in a report, a selector and a file name.
std::string read_station_name(const Value& value) {
  constexpr std::size_t kLongest = 64;
  const std::string_view name = value.as_string();
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (name.empty() || name.size() > kLongest || !std::all_of(name.begin(), name.end(), is_allowed)) {
    config::fail(value, "the name of a station is 1 to 64 of the characters a..z A..Z 0..9 _ - .");
  }
  return std::string(name);
}

StationDescription read_station(const Value& value) {
  return config::read_object(value, [](ObjectReader& object) {
    StationDescription station;
    station.name = read_station_name(object.required("name"));
    station.id_code = object.required("id_code").as_hex_or_integer<std::uint16_t>(0x1FFF);
    if (const auto bus = object.optional("bus")) {
      station.is_local = bus->as_choice<bool>({{"remote", false}, {"local", true}});
    }
    if (const auto cable = object.optional("cable")) {
      station.cable_m = cable->as_length_m();
      // The key itself is refused, so that the rule can be told from the shape alone.
      if (station.is_local) config::fail(*cable, "a local bus has no cable; remove the length");
    }
    if (const auto branch = object.optional("branch")) {
      for (const Value& element : branch->as_array()) station.branch.push_back(read_station(element));
    }
    return station;
  });
}

CopyRule read_copy(const Value& value) {
  return config::read_object(value, [](ObjectReader& object) {
    CopyRule rule;
    rule.from = read_station_name(object.required("from"));
    rule.to = read_station_name(object.required("to"));
    set_count(object, "input_word", rule.input_word, 0, 255);
    set_count(object, "output_word", rule.output_word, 0, 255);
    return rule;
  });
}

void read_bit_rate(const Value& value, Rules& rules) {
  rules.bit_rate = value.as_bit_rate(kSlowest, kFastest);
  if (rules.bit_rate == kPublishedFastRate) rules.max_distance_m = kDistanceAtFastRate;
}

Formula read_formula(const Value& value) {
  return value.as_choice<Formula>({{"f1", Formula::f1},
                                   {"f2", Formula::f2},
                                   {"f3", Formula::f3},
                                   {"f4", Formula::f4},
                                   {"f5", Formula::f5}});
}

NetworkDescription read_shape(const Value& root) {
  return config::read_object(root, [](ObjectReader& object) {
    NetworkDescription network;
    const Value name = object.required("name");
    network.name = name.as_string();
    if (network.name.empty()) config::fail(name, "a network has a name; write one");
    read_bit_rate(object.required("bit_rate"), network.rules);
    if (const auto formula = object.optional("formula")) network.formula = read_formula(*formula);
    if (const auto time = object.optional("cycle_time")) {
      network.cycle_time = time->as_duration(kernel::kMicrosecond, 10 * kernel::kSecond);
    }
    if (const auto rules = object.optional("rules")) {
      config::read_object(*rules, [&](ObjectReader& members) {
        read_line_rules(members, network.rules);
        read_cycle_rules(members, network.rules);
        read_supervision_rules(members, network.rules);
        read_word_rules(members, network.rules);
      });
    }
    for (const Value& station : object.required("stations").as_array(1)) {
      network.stations.push_back(read_station(station));
    }
    if (const auto copy = object.optional("copy")) {
      for (const Value& rule : copy->as_array()) network.copy.push_back(read_copy(rule));
    }
    return network;
  });
}

// The child of a container with this key or index; nothing when it is not written.
std::optional<Value> child_of(const Value& value, std::string_view token) {
  if (value.is_array()) {
    std::size_t index = 0;
    std::from_chars(token.data(), token.data() + token.size(), index);
    const auto elements = value.as_array();
    if (index < elements.size()) return elements[index];
  } else if (value.is_object()) {
    for (const config::Member& member : value.as_members()) {
      if (member.key == token) return member.value;
    }
  }
  return std::nullopt;
}

// The value at a pointer, or the last one on the way that is written: a default has no place of its own.
Value value_at(Value value, std::string_view pointer) {
  while (!pointer.empty()) {
    pointer.remove_prefix(1);
    const std::string_view token = pointer.substr(0, pointer.find('/'));
    const auto child = child_of(value, token);
    if (!child) break;
    value = *child;
    pointer.remove_prefix(token.size());
  }
  return value;
}

}  // namespace

NetworkDescription NetworkDescription::load(const std::filesystem::path& path) {
  const config::Document document = config::Document::load(path);
  return read(document.root());
}

NetworkDescription NetworkDescription::read(const config::Value& root) {
  NetworkDescription network = read_shape(root);
  if (const auto violation = check(network)) {
    config::fail(value_at(root, violation->pointer), violation->sentence);
  }
  return network;
}

}  // namespace fieldproof::interbus
