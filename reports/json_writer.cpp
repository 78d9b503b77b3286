#include "reports/json_writer.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "harness/config/document.hpp"
#include "harness/judge/result_json.hpp"
#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::ordered_json;
using kernel::as_utf8;

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
  Json plan = Json::array();
  for (const fault::PlanPart& part : identity.plan) {
    plan.push_back({{"place", as_utf8(part.place)}, {"name", as_utf8(part.name)}});
  }
  return {{"tool_version", as_utf8(identity.tool_version)},
          {"suite_version", as_utf8(identity.suite_version)},
          {"seed", decimal(identity.seed)},
          {"volume", as_utf8(identity.volume)},
          {"plan_hash", as_utf8(identity.plan_hash)},
          {"plan", std::move(plan)},
          {"network_hash", as_utf8(identity.network_hash)},
          {"pics_hash", as_utf8(identity.pics_hash)},
          {"caveats", strings_to_json(identity.caveats)},
          {"stale_expectations", strings_to_json(identity.stale_expectations)},
          {"selectors", strings_to_json(identity.selectors)},
          {"implementations", std::move(implementations)},
          {"inputs", judge::json_of(identity.inputs)},
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
          {"by_verdict", std::move(by_verdict)},
          {"expected", counts.expected}};
}

Json planned_faults_to_json(const std::vector<PlannedFault>& faults) {
  Json json = Json::array();
  for (const PlannedFault& fault : faults) {
    json.push_back({{"place", as_utf8(fault.part.place)},
                    {"name", as_utf8(fault.part.name)},
                    {"hits", decimal(fault.hits)},
                    {"cases_hit", fault.cases_hit},
                    {"cases", fault.cases}});
  }
  return json;
}

using config::ObjectReader;
using config::Value;

constexpr std::uint32_t kMostCases = 10'000'000;
constexpr int kMostPositions = 1'000'000;

std::string text_in(ObjectReader& object, std::string_view key) {
  return std::string(object.required(key).as_string());
}

// Reads a document of this schema; keys that it has grown since are skipped.
template <typename Read>
auto read_document(std::string_view text, const std::string& place, std::string_view schema, Read read) {
  const config::Document document = config::Document::parse(std::string(text), place);
  return config::read_open_object(document.root(), [&](ObjectReader& object) {
    const Value written = object.required("schema");
    if (written.as_string() != schema) {
      config::fail(written, fmt::format("this program reads \"schema\": \"{}\", the file has \"{}\"", schema,
                                        kernel::escaped_line(written.as_string())));
    }
    return read(object);
  });
}

std::vector<Implementation> implementations_from(const Value& list) {
  std::vector<Implementation> implementations;
  for (const Value& one : list.as_array()) {
    implementations.push_back(config::read_open_object(one, [](ObjectReader& object) {
      return Implementation{text_in(object, "role"),
                            object.required("position").as_integer<int>(0, kMostPositions),
                            text_in(object, "uri")};
    }));
  }
  return implementations;
}

std::vector<fault::PlanPart> plan_from(const Value& list) {
  std::vector<fault::PlanPart> plan;
  for (const Value& one : list.as_array()) {
    plan.push_back(config::read_open_object(one, [](ObjectReader& object) {
      return fault::PlanPart{text_in(object, "place"), text_in(object, "name")};
    }));
  }
  return plan;
}

RunIdentity identity_from(const Value& value) {
  return config::read_open_object(value, [](ObjectReader& object) {
    RunIdentity identity;
    identity.tool_version = text_in(object, "tool_version");
    identity.suite_version = text_in(object, "suite_version");
    identity.seed = judge::unsigned_from(object.required("seed"));
    if (const auto volume = object.optional("volume")) identity.volume = volume->as_string();
    identity.plan_hash = text_in(object, "plan_hash");
    if (const auto plan = object.optional("plan")) identity.plan = plan_from(*plan);
    identity.network_hash = text_in(object, "network_hash");
    if (const auto hash = object.optional("pics_hash")) identity.pics_hash = hash->as_string();
    if (const auto caveats = object.optional("caveats")) identity.caveats = judge::texts_from(*caveats);
    if (const auto stale = object.optional("stale_expectations")) {
      identity.stale_expectations = judge::texts_from(*stale);
    }
    identity.selectors = judge::texts_from(object.required("selectors"));
    identity.implementations = implementations_from(object.required("implementations"));
    if (const auto inputs = object.optional("inputs")) identity.inputs = judge::input_files_from(*inputs);
    identity.reproduce_options = text_in(object, "reproduce_options");
    identity.selected = object.required("selected").as_integer<std::uint32_t>(0, kMostCases);
    identity.incomplete_because = text_in(object, "incomplete_because");
    identity.exit_code = object.required("exit_code").as_integer<int>(0, 255);
    return identity;
  });
}

// Two results of one case would be two verdicts.
std::vector<judge::CaseResult> cases_from(const Value& list) {
  std::vector<judge::CaseResult> cases;
  std::set<std::string> ids;
  for (const Value& one : list.as_array(0, kMostCases)) {
    cases.push_back(judge::case_result_from(one));
    if (!ids.insert(cases.back().id).second) {
      config::fail(one, fmt::format("there is a result of '{}' already; remove one of the two",
                                    kernel::escaped_line(cases.back().id)));
    }
  }
  return cases;
}

}  // namespace

std::string results_json(const Run& run) {
  Json json = {{"schema", kResultsSchema},
               {"run", identity_to_json(run.identity)},
               {"headline", name(headline(run))},
               {"counts", counts_to_json(count(run))},
               {"planned_faults", planned_faults_to_json(planned_faults(run))},
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
  return read_document(text, place, kResultsSchema, [](ObjectReader& object) {
    Run run;
    run.identity = identity_from(object.required("run"));
    run.cases = cases_from(object.required("cases"));
    return run;
  });
}

Manifest manifest_from_json(std::string_view text, const std::string& place) {
  return read_document(text, place, kManifestSchema, [](ObjectReader& object) {
    Manifest manifest;
    config::read_open_object(object.required("build"), [&](ObjectReader& build) {
      manifest.build_type = text_in(build, "type");
      manifest.compiler = text_in(build, "compiler");
    });
    manifest.host = text_in(object, "host");
    manifest.arguments = judge::texts_from(object.required("arguments"));
    manifest.started = text_in(object, "started");
    manifest.finished = text_in(object, "finished");
    manifest.wall_time_us = judge::unsigned_from(object.required("wall_time_us"));
    manifest.jobs = object.required("jobs").as_integer<unsigned>();
    return manifest;
  });
}

void add_timings(std::string_view text, const std::string& place, Run& run) {
  read_document(text, place, kTimingsSchema, [&](ObjectReader& object) {
    std::map<std::string, std::uint64_t, std::less<>> times;
    for (const config::Member& time : object.required("cases").as_members()) {
      times.emplace(time.key, judge::unsigned_from(time.value));
    }
    for (judge::CaseResult& result : run.cases) {
      const auto found = times.find(result.id);
      if (found != times.end()) result.wall_time_us = found->second;
    }
  });
}

}  // namespace fieldproof::reports
