#include "reports/json_writer.hpp"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <nlohmann/json.hpp>

#include "harness/judge/result_json.hpp"
#include "harness/judge/untrusted_text.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::ordered_json;
using judge::as_utf8;

constexpr std::string_view kResultsSchema = "fieldproof/results/1";
constexpr std::string_view kManifestSchema = "fieldproof/manifest/1";
constexpr std::string_view kTimingsSchema = "fieldproof/timings/1";

std::string decimal(std::uint64_t value) {
  return fmt::format("{}", value);
}

std::string document_text(const Json& json) {
  return json.dump(1) + "\n";
}

Json strings_to_json(const std::vector<std::string>& strings) {
  Json json = Json::array();
  for (const std::string& string : strings) json.push_back(as_utf8(string));
  return json;
}

Json identity_to_json(const RunIdentity& identity) {
  Json implementations = Json::array();
  for (const Implementation& one : identity.implementations) {
    implementations.push_back(
        {{"role", as_utf8(one.role)}, {"position", one.position}, {"uri", as_utf8(one.uri)}});
  }
  return {{"tool_version", as_utf8(identity.tool_version)},
          {"suite_version", as_utf8(identity.suite_version)},
          {"seed", decimal(identity.seed)},
          {"plan_hash", as_utf8(identity.plan_hash)},
          {"network_hash", as_utf8(identity.network_hash)},
          {"selectors", strings_to_json(identity.selectors)},
          {"implementations", std::move(implementations)},
          {"reproduce_options", as_utf8(identity.reproduce_options)},
          {"selected", identity.selected},
          {"complete", identity.incomplete_because.empty()},
          {"incomplete_because", as_utf8(identity.incomplete_because)},
          {"exit_code", identity.exit_code}};
}

Json counts_to_json(const Counts& counts) {
  Json by_verdict = Json::object();
  for (std::size_t i = 0; i < kVerdicts; ++i) {
    by_verdict[std::string(name(static_cast<judge::Verdict>(i)))] = counts.by_verdict.at(i);
  }
  return {{"selected", counts.selected},
          {"judged", counts.judged},
          {"not_run", counts.not_run()},
          {"by_verdict", std::move(by_verdict)}};
}

[[noreturn]] void refuse(const std::string& place, const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::configuration, place + ": " + sentence);
}

Json document_from(std::string_view text, const std::string& place, std::string_view schema) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) refuse(place, fmt::format("this is no JSON object with \"schema\": \"{}\"", schema));
  const auto found = json.find("schema");
  if (found == json.end() || *found != schema) {
    refuse(place, fmt::format("this program reads \"schema\": \"{}\", the file has {}", schema,
                              found == json.end() ? "none" : found->dump()));
  }
  return json;
}

// Type errors of a document, with the place in front.
template <typename Read>
auto read_with_place(const std::string& place, Read read) {
  try {
    return read();
  } catch (const nlohmann::json::exception& error) {
    refuse(place, fmt::format("a key is missing or of a wrong type ({})", error.what()));
  }
}

std::uint64_t decimal_from(const Json& json, const std::string& place, const std::string& key) {
  const auto& digits = json.at(key).get_ref<const std::string&>();
  std::uint64_t value = 0;
  const char* end = digits.data() + digits.size();
  const auto [stop, failure] = std::from_chars(digits.data(), end, value);
  if (failure != std::errc{} || stop != end) {
    refuse(place, fmt::format("\"{}\" must be a string with a decimal 64-bit integer", key));
  }
  return value;
}

RunIdentity identity_from(const Json& json, const std::string& place) {
  RunIdentity identity;
  identity.tool_version = json.at("tool_version").get<std::string>();
  identity.suite_version = json.at("suite_version").get<std::string>();
  identity.seed = decimal_from(json, place, "seed");
  identity.plan_hash = json.at("plan_hash").get<std::string>();
  identity.network_hash = json.at("network_hash").get<std::string>();
  identity.selectors = json.at("selectors").get<std::vector<std::string>>();
  for (const Json& one : json.at("implementations")) {
    identity.implementations.push_back(
        {one.at("role").get<std::string>(), one.at("position").get<int>(), one.at("uri").get<std::string>()});
  }
  identity.reproduce_options = json.at("reproduce_options").get<std::string>();
  identity.selected = json.at("selected").get<std::size_t>();
  identity.incomplete_because = json.at("incomplete_because").get<std::string>();
  identity.exit_code = json.at("exit_code").get<int>();
  return identity;
}

}  // namespace

std::string results_json(const Run& run) {
  Json json = {{"schema", kResultsSchema},
               {"run", identity_to_json(run.identity)},
               {"headline", name(headline(run))},
               {"counts", counts_to_json(count(run))},
               {"cases", Json::array()}};
  for (const judge::CaseResult& result : run.cases) {
    json["cases"].push_back(judge::to_json(result, judge::WallTime::apart));
  }
  return document_text(json);
}

std::string manifest_json(const Manifest& manifest, const Run& run) {
  Json json = {{"schema", kManifestSchema},
               {"run", identity_to_json(run.identity)},
               {"build", {{"type", as_utf8(manifest.build_type)}, {"compiler", as_utf8(manifest.compiler)}}},
               {"host", as_utf8(manifest.host)},
               {"arguments", strings_to_json(manifest.arguments)},
               {"started", as_utf8(manifest.started)},
               {"finished", as_utf8(manifest.finished)},
               {"wall_time_us", decimal(manifest.wall_time_us)},
               {"jobs", manifest.jobs}};
  return document_text(json);
}

std::string timings_json(const Manifest& manifest, const Run& run) {
  Json json = {{"schema", kTimingsSchema},
               {"wall_time_us", decimal(manifest.wall_time_us)},
               {"cases", Json::object()}};
  for (const judge::CaseResult& result : run.cases) {
    json["cases"][as_utf8(result.id)] = decimal(result.wall_time_us);
  }
  return document_text(json);
}

Run run_from_json(std::string_view text, const std::string& place) {
  const Json json = document_from(text, place, kResultsSchema);
  return read_with_place(place, [&] {
    Run run;
    run.identity = identity_from(json.at("run"), place);
    for (const Json& one : json.at("cases")) {
      run.cases.push_back(judge::case_result_from(one, fmt::format("{}: cases/{}", place, run.cases.size())));
    }
    return run;
  });
}

Manifest manifest_from_json(std::string_view text, const std::string& place) {
  const Json json = document_from(text, place, kManifestSchema);
  return read_with_place(place, [&] {
    Manifest manifest;
    manifest.build_type = json.at("build").at("type").get<std::string>();
    manifest.compiler = json.at("build").at("compiler").get<std::string>();
    manifest.host = json.at("host").get<std::string>();
    manifest.arguments = json.at("arguments").get<std::vector<std::string>>();
    manifest.started = json.at("started").get<std::string>();
    manifest.finished = json.at("finished").get<std::string>();
    manifest.wall_time_us = decimal_from(json, place, "wall_time_us");
    manifest.jobs = json.at("jobs").get<unsigned>();
    return manifest;
  });
}

void add_timings(std::string_view text, const std::string& place, Run& run) {
  const Json json = document_from(text, place, kTimingsSchema);
  read_with_place(place, [&] {
    std::map<std::string, std::uint64_t, std::less<>> times;
    const Json& cases = json.at("cases");
    for (const auto& [id, unused] : cases.items()) times[id] = decimal_from(cases, place, id);
    for (judge::CaseResult& result : run.cases) {
      const auto found = times.find(result.id);
      if (found != times.end()) result.wall_time_us = found->second;
    }
  });
}

}  // namespace fieldproof::reports
