#include "conformance/interbus/playback.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "harness/config/document.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

using nlohmann::ordered_json;

constexpr int kVersion = 1;
constexpr std::size_t kMostLevels = 1 << 20;
constexpr kernel::Duration kLongestCycle = 10 * kernel::kSecond;

std::int64_t ticks(kernel::Time time) {
  return time.time_since_epoch().count();
}
// An instant of a run; what is far behind any run would only overflow.
kernel::Time read_time(const config::Value& value) {
  constexpr std::int64_t kLatest = 1'000'000'000'000'000'000;
  return kernel::Time{kernel::Duration{value.as_integer<std::int64_t>(0, kLatest)}};
}

// ---- writing ----

std::string hex_words(const line::Levels& levels) {
  std::string text;
  for (std::size_t i = 0; i < levels.word_count(); ++i) text += fmt::format("{:016x}", levels.words()[i]);
  return text;
}

ordered_json to_json(const interbus::MasterStatus& s) {
  ordered_json stations = ordered_json::array();
  for (const interbus::FoundStation& station : s.stations) {
    stations.push_back({station.id_code, station.words, station.before, station.on_branch ? 1 : 0});
  }
  return {{"state", static_cast<int>(s.state)},
          {"stations", std::move(stations)},
          {"configuration_error", s.configuration_error},
          {"counters",
           {s.data_cycles, s.id_cycles, s.rejected_cycles, s.rejected_data_cycles, s.consecutive_bad}},
          {"quality_bit", s.quality_bit},
          {"has_fault_location", s.has_fault_location},
          {"fault_location", {s.fault_location.from, s.fault_location.to}},
          {"peripheral_faults", s.peripheral_faults},
          {"reconfigurations", s.reconfigurations},
          {"cycle_time", s.cycle_time.count()}};
}

ordered_json to_json(const DeviceEvent& event) {
  ordered_json json = {{"at", ticks(event.at)}, {"call", event.call}};
  if (const auto* drive = std::get_if<DriveEvent>(&event.what)) {
    json["drive"] = {{"port", drive->port},
                     {"start", ticks(drive->wave.start)},
                     {"rate", drive->wave.rate},
                     {"size", drive->wave.levels.size()},
                     {"levels", hex_words(drive->wave.levels)}};
  } else if (const auto* output = std::get_if<OutputEvent>(&event.what)) {
    json["output"] = {{"word", output->word}, {"value", output->value}, {"when", ticks(output->when)}};
  } else if (const auto* hook = std::get_if<HookEvent>(&event.what)) {
    json["cycle_end"] = {{"data_cycle", hook->data_cycle}, {"accepted", hook->accepted}};
  } else if (const auto* view = std::get_if<ViewEvent>(&event.what)) {
    json["view"] = {{"status", to_json(view->status)}, {"inputs", view->inputs}, {"outputs", view->outputs}};
  }
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

DriveEvent read_drive(const config::Value& value) {
  return config::read_object(value, [](config::ObjectReader& o) {
    DriveEvent event;
    event.port = o.required("port").as_integer<unsigned>(0, 2);
    event.wave.start = read_time(o.required("start"));
    event.wave.rate = o.required("rate").as_integer(1, std::int64_t{1} << 40);
    const auto size = o.required("size").as_integer<std::size_t>(0, kMostLevels);
    event.wave.levels = read_levels(o.required("levels"), size);
    return event;
  });
}

std::vector<std::uint16_t> read_words(const config::Value& value) {
  std::vector<std::uint16_t> words;
  for (const config::Value& word : value.as_array(0, 8192)) words.push_back(word.as_integer<std::uint16_t>());
  return words;
}

std::vector<int> read_positions(const config::Value& value) {
  std::vector<int> positions;
  for (const config::Value& position : value.as_array(0, 8192))
    positions.push_back(position.as_integer<int>());
  return positions;
}

void read_stations(const config::Value& value, interbus::MasterStatus& status) {
  for (const config::Value& station : value.as_array(0, 8192)) {
    const auto parts = station.as_array(4, 4);
    status.stations.push_back({parts[0].as_integer<std::uint16_t>(), parts[1].as_integer<unsigned>(),
                               parts[2].as_integer<int>(), parts[3].as_integer<int>(0, 1) == 1});
  }
}

interbus::MasterStatus read_status(const config::Value& value) {
  return config::read_object(value, [](config::ObjectReader& o) {
    interbus::MasterStatus s;
    s.state = static_cast<interbus::MasterState>(
        o.required("state").as_integer<int>(0, static_cast<int>(interbus::MasterState::bus_stop)));
    read_stations(o.required("stations"), s);
    s.configuration_error = o.required("configuration_error").as_string();
    const auto counters = o.required("counters").as_array(5, 5);
    s.data_cycles = counters[0].as_integer<std::uint64_t>();
    s.id_cycles = counters[1].as_integer<std::uint64_t>();
    s.rejected_cycles = counters[2].as_integer<std::uint64_t>();
    s.rejected_data_cycles = counters[3].as_integer<std::uint64_t>();
    s.consecutive_bad = counters[4].as_integer<unsigned>();
    s.quality_bit = o.required("quality_bit").as_bool();
    s.has_fault_location = o.required("has_fault_location").as_bool();
    const auto location = o.required("fault_location").as_array(2, 2);
    s.fault_location = {location[0].as_integer<int>(), location[1].as_integer<int>()};
    s.peripheral_faults = read_positions(o.required("peripheral_faults"));
    s.reconfigurations = read_positions(o.required("reconfigurations"));
    s.cycle_time =
        kernel::Duration{o.required("cycle_time").as_integer<std::int64_t>(0, kLongestCycle.count())};
    return s;
  });
}

DeviceEvent read_event(const config::Value& value) {
  return config::read_object(value, [&](config::ObjectReader& o) {
    DeviceEvent event;
    event.at = read_time(o.required("at"));
    event.call = o.required("call").as_integer<std::uint64_t>();
    const auto drive = o.optional("drive");
    const auto output = o.optional("output");
    const auto cycle_end = o.optional("cycle_end");
    const auto view = o.optional("view");
    if (drive.has_value() + output.has_value() + cycle_end.has_value() + view.has_value() != 1) {
      config::fail(value, "an event is one of \"drive\", \"output\", \"cycle_end\" and \"view\"");
    }
    if (drive) {
      event.what = read_drive(*drive);
    } else if (output) {
      event.what = config::read_object(*output, [](config::ObjectReader& p) {
        return OutputEvent{p.required("word").as_integer<unsigned>(0, 255),
                           p.required("value").as_integer<std::uint16_t>(), read_time(p.required("when"))};
      });
    } else if (cycle_end) {
      event.what = config::read_object(*cycle_end, [](config::ObjectReader& p) {
        return HookEvent{p.required("data_cycle").as_bool(), p.required("accepted").as_bool()};
      });
    } else {
      event.what = config::read_object(*view, [](config::ObjectReader& p) {
        return ViewEvent{read_status(p.required("status")), read_words(p.required("inputs")),
                         read_words(p.required("outputs"))};
      });
    }
    return event;
  });
}

}  // namespace

namespace {

// Of the text of an event: names and instants, and numbers that are short mostly.
std::size_t estimated_octets(const DeviceEvent& event) {
  constexpr std::size_t kFixed = 400;
  constexpr std::size_t kNumber = 8;
  std::size_t numbers = 0;
  std::size_t more = kFixed;
  if (const auto* drive = std::get_if<DriveEvent>(&event.what)) more += drive->wave.levels.size() / 4;
  if (const auto* view = std::get_if<ViewEvent>(&event.what)) {
    const interbus::MasterStatus& status = view->status;
    numbers = view->inputs.size() + view->outputs.size() + status.peripheral_faults.size() +
              status.reconfigurations.size() + 6 * status.stations.size();
    more += status.configuration_error.size();
  }
  return kNumber * numbers + more;
}

}  // namespace

void DeviceRecording::add(std::size_t device, DeviceEvent event) {
  const std::size_t octets = estimated_octets(event);
  if (is_truncated_ || event_count_ == kMostEvents || octets_ + octets > kMostOctets) {
    is_truncated_ = true;
    return;
  }
  ++event_count_;
  octets_ += octets;
  devices_.at(device).push_back(std::move(event));
}

std::string DeviceRecording::text() const {
  ordered_json devices = ordered_json::array();
  for (const auto& events : devices_) {
    ordered_json list = ordered_json::array();
    for (const DeviceEvent& event : events) list.push_back(to_json(event));
    devices.push_back(std::move(list));
  }
  const ordered_json json = {{"version", kVersion}, {"devices", std::move(devices)}};
  // What an implementation says may be no UTF-8.
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

DeviceRecording DeviceRecording::load(const std::filesystem::path& path) {
  const config::Document document = config::Document::load(path);
  return config::read_object(document.root(), [name = path.string()](config::ObjectReader& o) {
    DeviceRecording recording;
    recording.name_ = name;
    o.required("version").as_integer(kVersion, kVersion);
    for (const config::Value& device : o.required("devices").as_array(0, 4096)) {
      const std::size_t number = recording.add_device();
      for (const config::Value& event : device.as_array(0, kMostEvents)) {
        recording.add(number, read_event(event));
      }
    }
    return recording;
  });
}

}  // namespace fieldproof::conformance
