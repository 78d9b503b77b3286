#include "harness/judge/result_json.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "harness/judge/untrusted_text.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::judge {
namespace {

using Json = nlohmann::ordered_json;

Json strings_to_json(const std::vector<std::string>& strings) {
  Json json = Json::array();
  for (const std::string& string : strings) json.push_back(as_utf8(string));
  return json;
}

Json reference_to_json(const Reference& reference) {
  return {{"source", as_utf8(reference.source)},
          {"clause", as_utf8(reference.clause)},
          {"standing", name(reference.standing)},
          {"verified", is_verified(reference.standing)}};
}

Json finding_to_json(const Finding& finding) {
  return {{"verdict", name(finding.verdict)},
          {"reason", as_utf8(finding.reason)},
          {"requirement", as_utf8(finding.requirement)},
          {"reference", reference_to_json(finding.reference)},
          {"expected", strings_to_json(finding.expected)},
          {"actual", as_utf8(finding.actual)},
          {"time_ps", fmt::format("{}", finding.time.time_since_epoch().count())},
          {"first_difference", as_utf8(finding.first_difference)},
          {"decode", strings_to_json(finding.decode)}};
}

Json measurement_to_json(const Measurement& measurement) {
  return {{"name", as_utf8(measurement.name)},
          {"unit", as_utf8(measurement.unit)},
          {"value", number_to_json(measurement.value)},
          {"low", number_to_json(measurement.low)},
          {"high", number_to_json(measurement.high)}};
}

template <typename T, typename ToJson>
Json list_to_json(const std::vector<T>& items, ToJson to_json) {
  Json json = Json::array();
  for (const T& item : items) json.push_back(to_json(item));
  return json;
}

// One object of a document and where it stands, for the sentence of an error.
class Fields {
 public:
  Fields(const Json& json, std::string place) : json_(json), place_(std::move(place)) {
    if (!json_.is_object()) throw_wrong("", "an object");
  }

  std::string text(const char* key) const {
    const Json& value = at(key);
    if (!value.is_string()) throw_wrong(key, "a string");
    return value.get<std::string>();
  }

  template <typename T>
  T integer(const char* key, int base = 10) const {
    const std::string digits = text(key);
    T value{};
    const char* end = digits.data() + digits.size();
    const auto [stop, failure] = std::from_chars(digits.data(), end, value, base);
    if (failure != std::errc{} || stop != end) {
      throw_wrong(key, base == 10 ? "a string with a decimal 64-bit integer"
                                  : "a string with a hexadecimal 64-bit integer");
    }
    return value;
  }

  double number(const char* key) const {
    const Json& value = at(key);
    if (value.is_number()) return value.get<double>();
    const std::string word = value.is_string() ? value.get<std::string>() : std::string();
    if (word == "nan") return std::numeric_limits<double>::quiet_NaN();
    if (word == "inf") return std::numeric_limits<double>::infinity();
    if (word == "-inf") return -std::numeric_limits<double>::infinity();
    throw_wrong(key, R"(a number, "nan", "inf" or "-inf")");
  }

  std::vector<std::string> texts(const char* key) const {
    std::vector<std::string> read;
    for (const Json& item : list(key)) {
      if (!item.is_string()) throw_wrong(key, "a list of strings");
      read.push_back(item.get<std::string>());
    }
    return read;
  }

  template <typename Read>
  auto objects(const char* key, Read read) const {
    std::vector<decltype(read(*this))> all;
    for (const Json& item : list(key)) {
      all.push_back(read(Fields(item, fmt::format("{}: {}/{}", place_, key, all.size()))));
    }
    return all;
  }

  Fields object(const char* key) const { return {at(key), fmt::format("{}: {}", place_, key)}; }

  template <typename T, typename From>
  T word(const char* key, From from, const char* what) const {
    const auto value = from(text(key));
    if (!value) throw_wrong(key, what);
    return *value;
  }

  bool has(const char* key) const { return json_.contains(key); }

 private:
  const Json& at(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) throw_wrong(key, "present");
    return *found;
  }

  const Json& list(const char* key) const {
    const Json& value = at(key);
    if (!value.is_array()) throw_wrong(key, "a list");
    return value;
  }

  [[noreturn]] void throw_wrong(std::string_view key, std::string_view right) const {
    const std::string what = key.empty() ? "the result of a case" : fmt::format("\"{}\"", key);
    throw kernel::Error(kernel::ErrorKind::configuration,
                        fmt::format("{}: {} must be {}", place_, what, right));
  }

  const Json& json_;
  std::string place_;
};

Reference reference_from(const Fields& fields) {
  return {fields.text("source"), fields.text("clause"),
          fields.word<Standing>(
              "standing", [](const std::string& word) { return standing_from(word); },
              "one of seed, sure, searched, calc, derived, memory, own")};
}

Verdict verdict_in(const Fields& fields) {
  return fields.word<Verdict>(
      "verdict", [](const std::string& word) { return verdict_from(word); },
      "one of none, not-applicable, pass, warn, inconclusive, fail, error");
}

Finding finding_from(const Fields& fields) {
  Finding finding;
  finding.verdict = verdict_in(fields);
  finding.reason = fields.text("reason");
  finding.requirement = fields.text("requirement");
  finding.reference = reference_from(fields.object("reference"));
  finding.expected = fields.texts("expected");
  finding.actual = fields.text("actual");
  finding.time = kernel::Time{kernel::Duration{fields.integer<std::int64_t>("time_ps")}};
  finding.first_difference = fields.text("first_difference");
  finding.decode = fields.texts("decode");
  return finding;
}

Measurement measurement_from(const Fields& fields) {
  return {fields.text("name"), fields.text("unit"), fields.number("value"), fields.number("low"),
          fields.number("high")};
}

}  // namespace

nlohmann::ordered_json number_to_json(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

std::string fingerprint_text(std::uint64_t fingerprint) {
  return fmt::format("{:016x}", fingerprint);
}

nlohmann::ordered_json to_json(const CaseResult& result, WallTime wall_time) {
  Json json = {{"id", as_utf8(result.id)},
               {"verdict", name(result.verdict)},
               {"reason", as_utf8(result.reason)},
               {"purpose", as_utf8(result.purpose)},
               {"requirement", as_utf8(result.requirement)},
               {"reference", reference_to_json(result.reference)},
               {"findings", list_to_json(result.findings, finding_to_json)},
               {"measurements", list_to_json(result.measurements, measurement_to_json)},
               {"seed", fmt::format("{}", result.seed)},
               {"fingerprint", fingerprint_text(result.fingerprint)},
               {"virtual_time_ps", fmt::format("{}", result.virtual_time.count())},
               {"log", as_utf8(result.log)}};
  if (wall_time == WallTime::included) json["wall_time_us"] = fmt::format("{}", result.wall_time_us);
  return json;
}

CaseResult case_result_from(const nlohmann::ordered_json& json, const std::string& place) {
  const Fields fields(json, place);
  CaseResult result;
  result.id = fields.text("id");
  result.verdict = verdict_in(fields);
  result.reason = fields.text("reason");
  result.purpose = fields.text("purpose");
  result.requirement = fields.text("requirement");
  result.reference = reference_from(fields.object("reference"));
  result.findings = fields.objects("findings", finding_from);
  result.measurements = fields.objects("measurements", measurement_from);
  result.seed = fields.integer<std::uint64_t>("seed");
  result.fingerprint = fields.integer<std::uint64_t>("fingerprint", 16);
  result.virtual_time = kernel::Duration{fields.integer<std::int64_t>("virtual_time_ps")};
  result.log = fields.text("log");
  if (fields.has("wall_time_us")) result.wall_time_us = fields.integer<std::uint64_t>("wall_time_us");
  return result;
}

}  // namespace fieldproof::judge
