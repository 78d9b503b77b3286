#include "cli/settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "harness/config/document.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "reports/results.hpp"

namespace fieldproof::cli {
namespace {

constexpr char kListSeparator = ';';  // of a variable of the environment; a URI may hold spaces and commas

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string::npos) return parts;
    begin = end + 1;
  }
}

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, failure] = std::from_chars(text.data(), end, value);
  if (failure != std::errc{} || rest != end || text.empty()) return std::nullopt;
  return value;
}

// A flag is on for these words, off for the others that are known.
std::optional<bool> truth(std::string_view text) {
  constexpr std::array<std::string_view, 3> kOn = {"1", "true", "yes"};
  constexpr std::array<std::string_view, 4> kOff = {"0", "false", "no", ""};
  if (std::find(kOn.begin(), kOn.end(), text) != kOn.end()) return true;
  if (std::find(kOff.begin(), kOff.end(), text) != kOff.end()) return false;
  return std::nullopt;
}

[[noreturn]] void refuse_at(const Setting& setting, const std::string& sentence) {
  const bool is_typed = setting.origin == Origin::command_line;
  throw kernel::Error(is_typed ? kernel::ErrorKind::usage : kernel::ErrorKind::configuration,
                      fmt::format("{}: {}", setting.place, sentence));
}

// An empty name would be taken for none at all, and an empty file for the folder of the call.
void refuse_empty(const Option& option, const Setting& setting) {
  if (option.kind != OptionKind::value && option.kind != OptionKind::list) return;
  for (const std::string& value : setting.values) {
    if (value.empty()) {
      refuse_at(setting,
                fmt::format("the value is empty; write {}, or leave the option out", option.value_name));
    }
  }
}

Setting fallback_of(const Option& option) {
  Setting setting;
  setting.place = fmt::format("default of --{}", option.name);
  if (option.name == "jobs" || option.name == "workers") {
    setting.values = {std::to_string(std::max(1U, std::thread::hardware_concurrency()))};
  } else if (!option.default_text.empty() && option.default_text.find('<') == std::string_view::npos) {
    setting.values = {std::string(option.default_text)};
  }
  return setting;
}

Setting from_command_line(const Option& option, std::vector<std::string> values) {
  Setting setting{std::move(values), Origin::command_line, fmt::format("--{}", option.name)};
  if (option.kind != OptionKind::list && option.kind != OptionKind::flag && setting.values.size() > 1) {
    refuse_at(setting, "is given more than once; leave one of them");
  }
  return setting;
}

Setting from_environment(const Option& option, const std::string& text) {
  Setting setting{{text}, Origin::environment, environment_name(option)};
  if (option.kind == OptionKind::list) setting.values = split(text, kListSeparator);
  if (option.kind == OptionKind::flag) {
    const auto is_on = truth(text);
    if (!is_on) refuse_at(setting, fmt::format("'{}' is neither on nor off; write 1 or 0", text));
    setting.values = *is_on ? std::vector<std::string>{"true"} : std::vector<std::string>{};
  }
  return setting;
}

std::string scalar_text(const config::Value& value) {
  const bool is_number =
      value.kind() == config::ValueKind::integer || value.kind() == config::ValueKind::number;
  if (is_number) return std::to_string(value.as_integer<std::uint64_t>());
  return std::string(value.as_string());
}

Setting from_file(const Option& option, const config::Value& value, const std::string& file, Origin origin) {
  Setting setting{{}, origin, fmt::format("{}:{}: {}", file, value.line(), value.pointer())};
  if (option.kind == OptionKind::flag) {
    if (value.as_bool()) setting.values = {"true"};
  } else if (option.kind == OptionKind::list && value.is_array()) {
    for (const config::Value& element : value.as_array()) setting.values.push_back(scalar_text(element));
  } else {
    setting.values = {scalar_text(value)};
  }
  return setting;
}

std::string told(Origin origin, const std::string& place) {
  switch (origin) {
    case Origin::fallback:
      return "default";
    case Origin::command_line:
      return "command line";
    case Origin::environment:
      return "environment, " + place;
    case Origin::file:
      return "file, " + place;
    case Origin::stored_run:
      return "stored run, " + place;
  }
  return place;
}

bool is_path(const Option& option) {
  return option.value_name == "FILE" || option.value_name == "DIR";
}

}  // namespace

Environment process_environment() {
  return [](const std::string& name) -> std::optional<std::string> {
    const char* value = std::getenv(name.c_str());
    if (value == nullptr || *value == '\0') return std::nullopt;
    return value;
  };
}

std::vector<std::string> unknown_variables(const char* const* variables) {
  std::vector<std::string> known;
  for (const Option& option : options())
    if (!option.is_of_the_moment) known.push_back(environment_name(option));
  std::vector<std::string> sentences;
  for (; *variables != nullptr; ++variables) {
    const std::string_view variable = *variables;
    const std::string_view name = variable.substr(0, variable.find('='));
    if (!name.starts_with(kVariablePrefix) || std::ranges::find(known, name) != known.end()) continue;
    const auto nearest = config::nearest(name, std::span<const std::string>(known), 1);
    sentences.push_back(fmt::format("the variable {} sets nothing; the nearest one that does is {}",
                                    kernel::escaped_line(name), nearest.front()));
  }
  return sentences;
}

std::optional<std::chrono::milliseconds> duration_of(std::string_view written) {
  constexpr std::uint64_t kLongest = 1'000'000;  // of any unit
  constexpr std::size_t kMostDecimals = 6;
  constexpr std::array<std::pair<std::string_view, std::int64_t>, 5> kUnits = {
      {{"ms", 1}, {"s", 1000}, {"min", 60'000}, {"h", 3'600'000}, {"", 1000}}};
  const std::size_t end = std::min(written.find_first_not_of("0123456789."), written.size());
  const std::string_view number = written.substr(0, end);
  const std::size_t point = std::min(number.find('.'), number.size());
  const std::string_view decimals = number.substr(std::min(point + 1, number.size()));
  // 1.5 is 1,500,000 millionths.
  const std::string millionths = fmt::format("{}{:0<{}}", number.substr(0, point), decimals, kMostDecimals);
  const auto count = whole_number(millionths);
  const bool is_number = count && point > 0 && decimals.size() <= kMostDecimals && !number.ends_with('.');
  constexpr std::int64_t kMillion = 1'000'000;
  std::string_view unit = written.substr(end);
  if (unit.starts_with(' ')) unit.remove_prefix(1);
  for (const auto& [unit_name, milliseconds] : kUnits) {
    if (unit != unit_name || !is_number || *count == 0 || *count > kLongest * kMillion) continue;
    const std::int64_t parts = static_cast<std::int64_t>(*count) * milliseconds;
    if (parts % kMillion == 0) return std::chrono::milliseconds(parts / kMillion);
  }
  return std::nullopt;
}

Settings::Settings(const Command& command, const Environment& environment) : verb_(command.verb) {
  for (const Option& option : options()) {
    if (!is_known_to(option, verb_)) continue;
    Setting setting = fallback_of(option);
    const auto typed = command.values.find(option.name);
    if (typed != command.values.end()) {
      setting = from_command_line(option, typed->second);
    } else if (!option.is_of_the_moment) {
      if (const auto value = environment(environment_name(option)))
        setting = from_environment(option, *value);
    }
    refuse_empty(option, setting);
    settings_.emplace(option.name, std::move(setting));
  }
  if (settings_.contains("config") && is_set("config")) add_file(text("config"), Origin::file);
}

void Settings::add_file(const std::filesystem::path& file, Origin origin) {
  const config::Document document = config::Document::load(file);
  config::read_object(document.root(), [&](config::ObjectReader& reader) {
    for (const Option& option : options()) {
      if (option.is_of_the_moment || option.name == "config") continue;
      const auto value = reader.optional(file_key(option));
      const auto own = settings_.find(option.name);
      if (!value || own == settings_.end() || !is_known_to(option, verb_)) continue;
      if (own->second.origin != Origin::fallback) continue;
      // Where the stored run went and how it was shown is no matter of this one.
      if (origin == Origin::stored_run && !option.decides_outcome && !option.decides_exit_code) continue;
      own->second = from_file(option, *value, file.string(), origin);
      refuse_empty(option, own->second);
    }
  });
}

const Setting& Settings::setting(std::string_view name) const {
  const auto found = settings_.find(name);
  FIELDPROOF_CHECK(found != settings_.end(), fmt::format("the verb '{}' has no option '{}'", verb_, name));
  return found->second;
}

void Settings::reset(std::string_view name) {
  if (const Option* option = find_option(name, verb_))
    settings_.insert_or_assign(std::string(name), fallback_of(*option));
}

void Settings::refuse(std::string_view name, const std::string& sentence) const {
  refuse_at(setting(name), sentence);
}

bool Settings::is_set(std::string_view name) const {
  return !setting(name).values.empty();
}

const std::vector<std::string>& Settings::list(std::string_view name) const {
  return setting(name).values;
}

std::string Settings::text(std::string_view name) const {
  const Setting& found = setting(name);
  return found.values.empty() ? std::string{} : found.values.front();
}

std::uint64_t Settings::number(std::string_view name, std::uint64_t min, std::uint64_t max) const {
  const std::string written = text(name);
  const auto value = whole_number(written);
  if (!value || *value < min || *value > max) {
    refuse(name,
           fmt::format("'{}' is no whole number {} to {}; write for example {}", written, min, max, min + 1));
  }
  return *value;
}

std::vector<double> Settings::reals(std::string_view name) const {
  std::vector<double> values;
  for (const std::string& written : list(name)) {
    double value = 0;
    const char* end = written.data() + written.size();
    const auto [rest, failure] = std::from_chars(written.data(), end, value);
    if (failure != std::errc{} || rest != end || written.empty()) {
      refuse(name, fmt::format("'{}' is no number; write for example 1e-3", written));
    }
    values.push_back(value);
  }
  return values;
}

std::vector<std::string> Settings::words(std::string_view name) const {
  std::vector<std::string> words;
  for (const std::string& written : list(name)) {
    for (std::size_t begin = 0; begin <= written.size();) {
      const std::size_t end = std::min(written.find(',', begin), written.size());
      words.push_back(written.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  return words;
}

std::optional<std::chrono::milliseconds> Settings::duration(std::string_view name) const {
  const std::string written = text(name);
  if (written.empty()) return std::nullopt;
  if (const auto time = duration_of(written)) return time;
  refuse(
      name,
      fmt::format("'{}' is no time of whole milliseconds, from 1 ms on; write a number with ms, s, min or h, "
                  "for example 90s or 1.5 min",
                  written));
}

std::size_t Settings::choice(std::string_view name) const {
  const Option* option = find_option(name, verb_);
  FIELDPROOF_CHECK(option != nullptr, "a choice is asked for that the table does not have");
  const std::vector<std::string> words = split(std::string(option->value_name), '|');
  const auto found = std::find(words.begin(), words.end(), text(name));
  if (found == words.end())
    refuse(name, fmt::format("'{}' is none of '{}'", text(name), fmt::join(words, "', '")));
  return static_cast<std::size_t>(found - words.begin());
}

std::string Settings::describe() const {
  std::string lines;
  for (const Option& option : options()) {
    if (!is_known_to(option, verb_) || option.is_of_the_moment) continue;
    const Setting& own = setting(option.name);
    std::string value = fmt::format("{}", fmt::join(own.values, " ; "));
    if (option.kind == OptionKind::flag) value = own.values.empty() ? "false" : "true";
    if (value.empty()) value = option.default_text.empty() ? "-" : option.default_text;
    lines += fmt::format("{:<20} {:<32} {}\n", option.name, value, told(own.origin, own.place));
  }
  return lines;
}

std::string Settings::as_file() const {
  nlohmann::ordered_json file = nlohmann::ordered_json::object();
  for (const Option& option : options()) {
    if (!is_known_to(option, verb_) || option.is_of_the_moment || option.name == "config") continue;
    const Setting& own = setting(option.name);
    if (own.origin == Origin::fallback) continue;
    std::vector<std::string> values = own.values;
    if (is_path(option)) {
      for (std::string& value : values) value = std::filesystem::absolute(value).string();
    }
    if (option.kind == OptionKind::flag) {
      file[file_key(option)] = !values.empty();
    } else if (option.kind == OptionKind::list) {
      file[file_key(option)] = values;
    } else {
      file[file_key(option)] = values.front();
    }
  }
  return file.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::vector<std::pair<const Option*, const std::vector<std::string>*>> Settings::deciding() const {
  std::vector<std::pair<const Option*, const std::vector<std::string>*>> options_with_values;
  for (const Option& option : options()) {
    if (!option.decides_outcome || !is_known_to(option, verb_)) continue;
    const Setting& own = setting(option.name);
    if (own.origin != Origin::fallback || option.name == "seed")
      options_with_values.emplace_back(&option, &own.values);
  }
  return options_with_values;
}

std::string Settings::reproduce_options() const {
  std::vector<std::string> words;
  for (const auto& [option, values] : deciding()) {
    for (const std::string& value : *values)
      words.push_back(fmt::format("--{} {}", option->name, reports::shell_quoted(value)));
  }
  return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace fieldproof::cli
