// From a JSON document to a NetworkDescription: the shape that network.schema.json writes down, then `check`.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "harness/config/name.hpp"
#include "harness/field/json_reader.hpp"
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
    network.name = config::read_name(object.required("name"));
    read_bit_rate(object.required("bit_rate"), network.rules);
    if (const auto formula = object.optional("formula")) network.formula = read_formula(*formula);
    if (const auto time = object.optional("cycle_time")) {
      network.cycle_time = time->as_duration(kernel::kMicrosecond, 10 * kernel::kSecond);
    }
    if (const auto rules = object.optional("rules")) {
      config::read_object(
          *rules, [&](ObjectReader& members) { field::read_members(members, kRulesInAFile, network.rules); });
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
