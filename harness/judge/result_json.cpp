#include "harness/judge/result_json.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "harness/kernel/error.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::judge {
namespace {

using Json = nlohmann::ordered_json;

Json strings_to_json(const std::vector<std::string>& strings) {
  Json json = Json::array();
  for (const std::string& string : strings) json.push_back(kernel::as_utf8(string));
  return json;
}

Json reference_to_json(const Reference& reference) {
  return {{"source", kernel::as_utf8(reference.source)},
          {"clause", kernel::as_utf8(reference.clause)},
          {"standing", name(reference.standing)},
          {"verified", is_verified(reference.standing)}};
}

Json finding_to_json(const Finding& finding) {
  return {{"verdict", name(finding.verdict)},
          {"reason", kernel::as_utf8(finding.reason)},
          {"requirement", kernel::as_utf8(finding.requirement)},
          {"reference", reference_to_json(finding.reference)},
          {"expected", strings_to_json(finding.expected)},
          {"actual", kernel::as_utf8(finding.actual)},
          {"time_ps", fmt::format("{}", finding.time.time_since_epoch().count())},
          {"step", kernel::as_utf8(finding.step)},
          {"first_difference", kernel::as_utf8(finding.first_difference)},
          {"decisive", strings_to_json(finding.decisive)},
          {"decode", strings_to_json(finding.decode)}};
}

Json measurement_to_json(const Measurement& measurement) {
  return {{"name", kernel::as_utf8(measurement.name)},
          {"unit", kernel::as_utf8(measurement.unit)},
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

using config::ObjectReader;
using config::Value;

template <typename T>
T integer_from(const Value& value, int base) {
  const std::string_view digits = value.as_string();
  T read{};
  const char* end = digits.data() + digits.size();
  const auto [stop, failure] = std::from_chars(digits.data(), end, read, base);
  if (failure != std::errc{} || stop != end) {
    config::fail(value, fmt::format("this is no {} 64-bit integer; write its digits as a string",
                                    base == 10 ? "decimal" : "hexadecimal"));
  }
  return read;
}

double number_from(const Value& value) {
  if (!value.is_string()) return value.as_number();
  constexpr std::array<std::string_view, 3> kWords = {"nan", "inf", "-inf"};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::array<double, 3> kMeanings = {std::numeric_limits<double>::quiet_NaN(), kInfinity,
                                               -kInfinity};
  return kMeanings.at(value.as_choice(kWords));
}

template <typename From>
auto word_from(const Value& value, From from, std::string_view what) {
  const auto known = from(value.as_string());
  if (!known) config::fail(value, fmt::format("this is none of {}", what));
  return *known;
}

template <typename Read>
auto list_from(const Value& value, Read read) {
  std::vector<decltype(read(value))> all;
  for (const Value& item : value.as_array()) all.push_back(read(item));
  return all;
}

std::string text_in(ObjectReader& object, std::string_view key) {
  return std::string(object.required(key).as_string());
}

Reference reference_from(const Value& value) {
  return config::read_open_object(value, [](ObjectReader& object) {
    const auto from = [](std::string_view word) { return standing_from(word); };
    return Reference{
        text_in(object, "source"), text_in(object, "clause"),
        word_from(object.required("standing"), from, "seed, sure, searched, calc, derived, memory, own")};
  });
}

Finding finding_from(const Value& value) {
  return config::read_open_object(value, [](ObjectReader& object) {
    Finding finding;
    finding.verdict = verdict_from(object.required("verdict"));
    finding.reason = text_in(object, "reason");
    finding.requirement = text_in(object, "requirement");
    finding.reference = reference_from(object.required("reference"));
    finding.expected = texts_from(object.required("expected"));
    finding.actual = text_in(object, "actual");
    finding.time = kernel::Time{kernel::Duration{integer_from<std::int64_t>(object.required("time_ps"), 10)}};
    finding.step = text_in(object, "step");
    finding.first_difference = text_in(object, "first_difference");
    finding.decisive = texts_from(object.required("decisive"));
    finding.decode = texts_from(object.required("decode"));
    return finding;
  });
}

Measurement measurement_from(const Value& value) {
  return config::read_open_object(value, [](ObjectReader& object) {
    return Measurement{text_in(object, "name"), text_in(object, "unit"),
                       number_from(object.required("value")), number_from(object.required("low")),
                       number_from(object.required("high"))};
  });
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
  Json json = {{"id", kernel::as_utf8(result.id)},
               {"verdict", name(result.verdict)},
               {"reason", kernel::as_utf8(result.reason)},
               {"purpose", kernel::as_utf8(result.purpose)},
               {"requirement", kernel::as_utf8(result.requirement)},
               {"reference", reference_to_json(result.reference)},
               {"findings", list_to_json(result.findings, finding_to_json)},
               {"measurements", list_to_json(result.measurements, measurement_to_json)},
               {"seed", fmt::format("{}", result.seed)},
               {"fingerprint", fingerprint_text(result.fingerprint)},
               {"virtual_time_ps", fmt::format("{}", result.virtual_time.count())},
               {"log", kernel::as_utf8(result.log)}};
  if (!result.settings.empty()) json["settings"] = strings_to_json(result.settings);
  if (!result.planned_hits.empty()) {
    json["planned_hits"] =
        list_to_json(result.planned_hits, [](std::uint64_t hits) { return fmt::format("{}", hits); });
  }
  if (!result.expected_because.empty()) json["expected_because"] = kernel::as_utf8(result.expected_because);
  if (wall_time == WallTime::included) json["wall_time_us"] = fmt::format("{}", result.wall_time_us);
  return json;
}

std::uint64_t unsigned_from(const Value& value, int base) {
  return integer_from<std::uint64_t>(value, base);
}

Verdict verdict_from(const Value& value) {
  const auto from = [](std::string_view word) { return verdict_from(word); };
  return word_from(value, from, "none, not-applicable, pass, warn, inconclusive, fail, error");
}

std::vector<std::string> texts_from(const Value& value) {
  return list_from(value, [](const Value& item) { return std::string(item.as_string()); });
}

CaseResult case_result_from(const Value& value) {
  return config::read_open_object(value, [](ObjectReader& object) {
    CaseResult result;
    result.id = text_in(object, "id");
    result.verdict = verdict_from(object.required("verdict"));
    result.reason = text_in(object, "reason");
    result.purpose = text_in(object, "purpose");
    result.requirement = text_in(object, "requirement");
    result.reference = reference_from(object.required("reference"));
    result.findings = list_from(object.required("findings"), finding_from);
    result.measurements = list_from(object.required("measurements"), measurement_from);
    result.seed = unsigned_from(object.required("seed"));
    result.fingerprint = unsigned_from(object.required("fingerprint"), 16);
    result.virtual_time =
        kernel::Duration{integer_from<std::int64_t>(object.required("virtual_time_ps"), 10)};
    result.log = text_in(object, "log");
    if (const auto settings = object.optional("settings")) result.settings = texts_from(*settings);
    if (const auto hits = object.optional("planned_hits")) {
      result.planned_hits = list_from(*hits, [](const Value& one) { return unsigned_from(one); });
    }
    if (const auto because = object.optional("expected_because")) {
      result.expected_because = because->as_string();
    }
    if (const auto time = object.optional("wall_time_us")) result.wall_time_us = unsigned_from(*time);
    return result;
  });
}

}  // namespace fieldproof::judge
