#include "harness/iut/device_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "harness/config/document.hpp"

namespace fieldproof::iut {
namespace {

using nlohmann::ordered_json;

constexpr int kVersion = 3;
constexpr std::size_t kMostLevelsOfAWave = std::size_t{1} << 28U;
constexpr std::array<std::string_view, 7> kCallNames = {"begin",    "power", "characters", "levels",
                                                        "activity", "time",  "end"};
// Of an act or a call without what it carries.
constexpr std::size_t kFixedOctets = 60;
constexpr std::size_t kOctetsOfADevice = 250;

std::int64_t ticks(kernel::Time time) {
  return time.time_since_epoch().count();
}
kernel::Time read_time(const config::Value& value) {
  return kernel::Time{kernel::Duration{value.as_integer<std::int64_t>()}};
}

std::size_t estimated_octets(const Act& act) {
  if (const auto* drove = std::get_if<DroveLevels>(&act)) return kFixedOctets + drove->wave.levels.size() / 4;
  if (const auto* sent = std::get_if<Sent>(&act)) return kFixedOctets + 6 * sent->characters.size();
  if (const auto* done = std::get_if<Misbehaved>(&act)) {
    std::size_t octets = kFixedOctets + 2 * done->sentence.size();
    for (const std::string& line : done->evidence) octets += 2 * line.size() + 4;
    return octets;
  }
  return kFixedOctets;
}

// ---- writing ----

std::string hex_words(const line::Levels& levels) {
  std::string text;
  for (std::size_t i = 0; i < levels.word_count(); ++i) text += fmt::format("{:016x}", levels.words()[i]);
  return text;
}

ordered_json to_json(const Misbehaved& done) {
  return {{"reason", done.reason}, {"sentence", done.sentence}, {"evidence", done.evidence}};
}

struct ActWriter {
  ordered_json operator()(const SwitchedDriver& driver) const {
    return {{"driver", {driver.port, driver.is_on, ticks(driver.at)}}};
  }
  ordered_json operator()(const Sent& sent) const {
    return {{"characters", {sent.port, ticks(sent.start), sent.characters}}};
  }
  ordered_json operator()(const DroveLevels& drove) const {
    const line::Waveform& wave = drove.wave;
    return {
        {"levels", {drove.port, ticks(wave.start), wave.rate, wave.levels.size(), hex_words(wave.levels)}}};
  }
  ordered_json operator()(const Wrote& wrote) const {
    return {{"write", {wrote.item, wrote.value, ticks(wrote.when)}}};
  }
  ordered_json operator()(const WasRead& read) const { return {{"read", {read.item, ticks(read.when)}}}; }
  ordered_json operator()(const WasUncertain& was) const {
    return {{"uncertain", {was.uncertainty.earlier.count(), was.uncertainty.later.count()}}};
  }
  ordered_json operator()(const Misbehaved& done) const { return {{"misbehaves", to_json(done)}}; }
  ordered_json operator()(const CouldNot& could) const {
    return {{could.is_in_doubt ? "in_doubt" : "cannot", could.sentence}};
  }
};

ordered_json to_json(const RecordedCall& call) {
  ordered_json json = {{"call", name(call.kind)}, {"at", ticks(call.at)}};
  if (call.next != kernel::kNever) json["next"] = ticks(call.next);
  if (call.acts.empty()) return json;
  for (const Act& act : call.acts) json["acts"].push_back(std::visit(ActWriter{}, act));
  return json;
}

constexpr std::array kCapabilities = {
    std::pair{"process_side", &Capabilities::process_side},
    std::pair{"moving_inputs", &Capabilities::moving_inputs},
    std::pair{"driver_control", &Capabilities::driver_control},
    std::pair{"distance", &Capabilities::distance},
    std::pair{"power", &Capabilities::power},
    std::pair{"is_wall_clock", &Capabilities::is_wall_clock},
    std::pair{"senses_activity", &Capabilities::senses_activity},
};

ordered_json to_json(const RecordedDevice& device) {
  if (device.failure) return {{"failure", to_json(*device.failure)}};
  ordered_json capabilities;
  for (const auto& [key, member] : kCapabilities) capabilities[key] = device.capabilities.*member;
  ordered_json json = {{"unit", name(device.unit)},
                       {"capabilities", std::move(capabilities)},
                       {"takes_case", device.takes_case},
                       {"calls", ordered_json::array()}};
  for (const RecordedCall& call : device.calls) json["calls"].push_back(to_json(call));
  return json;
}

// ---- reading ----

line::Levels read_levels(const config::Value& value, std::size_t size) {
  const std::string_view text = value.as_string();
  if (text.size() != (size + 63) / 64 * 16) config::fail(value, "has not 16 digits for each 64 levels");
  line::Levels levels;
  for (std::size_t n = 0; n < size; n += 64) {
    std::uint64_t word = 0;
    for (const char digit : text.substr(n / 4, 16)) {
      const std::size_t nibble = std::string_view("0123456789abcdef").find(digit);
      if (nibble == std::string_view::npos)
        config::fail(value, "has a character that is no hexadecimal digit");
      word = word << 4 | nibble;
    }
    levels.append(word, static_cast<unsigned>(std::min<std::size_t>(64, size - n)));
  }
  return levels;
}

Misbehaved read_misbehaved(const config::Value& value) {
  return config::read_object(value, [](config::ObjectReader& o) {
    Misbehaved done{
        std::string(o.required("reason").as_string()), std::string(o.required("sentence").as_string()), {}};
    for (const config::Value& line : o.required("evidence").as_array(0, 65'536))
      done.evidence.emplace_back(line.as_string());
    return done;
  });
}

SwitchedDriver read_driver(const config::Value& value) {
  const auto parts = value.as_array(3, 3);
  return {parts[0].as_integer<unsigned>(), parts[1].as_bool(), read_time(parts[2])};
}

Sent read_sent(const config::Value& value) {
  const auto parts = value.as_array(3, 3);
  Sent sent{parts[0].as_integer<unsigned>(), read_time(parts[1]), {}};
  for (const config::Value& one : parts[2].as_array(0, 65'536))
    sent.characters.push_back(one.as_integer<std::uint16_t>());
  return sent;
}

DroveLevels read_drove(const config::Value& value) {
  const auto parts = value.as_array(5, 5);
  DroveLevels drove;
  drove.port = parts[0].as_integer<unsigned>();
  drove.wave.start = read_time(parts[1]);
  drove.wave.rate = parts[2].as_integer<std::int64_t>(1, std::int64_t{1} << 40);
  drove.wave.levels = read_levels(parts[4], parts[3].as_integer<std::size_t>(0, kMostLevelsOfAWave));
  return drove;
}

Act read_numbers(config::ObjectReader& o, const config::Value& value) {
  if (const auto write = o.optional("write")) {
    const auto parts = write->as_array(3, 3);
    return Wrote{parts[0].as_integer<Item>(), parts[1].as_integer<std::uint64_t>(), read_time(parts[2])};
  }
  if (const auto read = o.optional("read")) {
    const auto parts = read->as_array(2, 2);
    return WasRead{parts[0].as_integer<Item>(), read_time(parts[1])};
  }
  if (const auto uncertain = o.optional("uncertain")) {
    const auto parts = uncertain->as_array(2, 2);
    const auto within_an_hour = [](const config::Value& part) {
      return kernel::Duration{part.as_integer<std::int64_t>(0, 3600 * kernel::kSecond.count())};
    };
    return WasUncertain{{within_an_hour(parts[0]), within_an_hour(parts[1])}};
  }
  config::fail(
      value,
      "an act is one of driver, characters, levels, write, read, uncertain, misbehaves, cannot and in_doubt");
}

Act read_act(const config::Value& value) {
  return config::read_object(value, [&](config::ObjectReader& o) -> Act {
    if (const auto driver = o.optional("driver")) return read_driver(*driver);
    if (const auto sent = o.optional("characters")) return read_sent(*sent);
    if (const auto drove = o.optional("levels")) return read_drove(*drove);
    if (const auto done = o.optional("misbehaves")) return read_misbehaved(*done);
    if (const auto could = o.optional("cannot")) return CouldNot{std::string(could->as_string())};
    if (const auto doubt = o.optional("in_doubt")) return CouldNot{std::string(doubt->as_string()), true};
    return read_numbers(o, value);
  });
}

RecordedCall read_call(const config::Value& value) {
  return config::read_object(value, [](config::ObjectReader& o) {
    RecordedCall call;
    const config::Value kind = o.required("call");
    const auto found = std::ranges::find(kCallNames, std::string_view(kind.as_string()));
    if (found == kCallNames.end()) config::fail(kind, "is no call of a bench");
    call.kind = static_cast<CallKind>(found - kCallNames.begin());
    call.at = read_time(o.required("at"));
    if (const auto next = o.optional("next")) call.next = read_time(*next);
    if (const auto acts = o.optional("acts")) {
      for (const config::Value& act : acts->as_array()) call.acts.push_back(read_act(act));
    }
    return call;
  });
}

UnitKind read_unit(const config::Value& value) {
  for (const UnitKind unit : {UnitKind::characters, UnitKind::levels, UnitKind::telegrams})
    if (value.as_string() == name(unit)) return unit;
  config::fail(value, "is no unit; there are characters, levels and telegrams");
}

RecordedDevice read_device(const config::Value& value) {
  return config::read_object(value, [](config::ObjectReader& o) {
    RecordedDevice device;
    if (const auto failure = o.optional("failure")) {
      device.failure = read_misbehaved(*failure);
      return device;
    }
    device.unit = read_unit(o.required("unit"));
    config::read_object(o.required("capabilities"), [&](config::ObjectReader& c) {
      for (const auto& [key, member] : kCapabilities) {
        // One that was recorded before there was such a thing has it not.
        if (const auto found = c.optional(key)) device.capabilities.*member = found->as_bool();
      }
      return 0;
    });
    device.takes_case = o.required("takes_case").as_bool();
    for (const config::Value& call : o.required("calls").as_array()) device.calls.push_back(read_call(call));
    return device;
  });
}

}  // namespace

std::string_view name(CallKind kind) {
  return kCallNames.at(static_cast<std::size_t>(kind));
}

bool DeviceRecording::has_room(std::size_t octets) {
  is_truncated_ = is_truncated_ || octets_ + octets > kMostOctets;
  if (!is_truncated_) octets_ += octets;
  return !is_truncated_;
}

std::size_t DeviceRecording::add(RecordedDevice device) {
  if (!has_room(kOctetsOfADevice)) return devices_.size();
  devices_.push_back(std::move(device));
  return devices_.size() - 1;
}

void DeviceRecording::begin_call(std::size_t device, CallKind kind, kernel::Time at) {
  if (has_room(kFixedOctets)) devices_[device].calls.push_back({kind, at, kernel::kNever, {}});
}

void DeviceRecording::add(std::size_t device, Act act) {
  if (has_room(estimated_octets(act))) devices_[device].calls.back().acts.push_back(std::move(act));
}

void DeviceRecording::end_call(std::size_t device, kernel::Time next) {
  if (!is_truncated_) devices_[device].calls.back().next = next;
}

void DeviceRecording::set_takes_case(std::size_t device, bool takes_case) {
  if (!is_truncated_) devices_[device].takes_case = takes_case;
}

std::string DeviceRecording::text() const {
  ordered_json json = {{"version", kVersion}, {"devices", ordered_json::array()}};
  for (const RecordedDevice& device : devices_) json["devices"].push_back(to_json(device));
  // What an implementation says may be no UTF-8.
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

DeviceRecording DeviceRecording::load(const std::filesystem::path& path) {
  const config::Document document = config::Document::load(path);
  return config::read_object(document.root(), [name = path.string()](config::ObjectReader& o) {
    DeviceRecording recording;
    recording.name_ = name;
    o.required("version").as_integer(kVersion, kVersion);
    for (const config::Value& device : o.required("devices").as_array()) recording.add(read_device(device));
    return recording;
  });
}

}  // namespace fieldproof::iut
