#include "reports/sarif_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <vector>

#include "harness/kernel/time.hpp"
#include "reports/outcome.hpp"
#include "reports/text_summary.hpp"
#include "reports/utc_time.hpp"

namespace fieldproof::reports {
namespace {

using judge::CaseResult;
using judge::Verdict;
using Json = nlohmann::ordered_json;

constexpr std::string_view kSarifSchema =
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/os/schemas/sarif-schema-2.1.0.json";
constexpr const char* kCaseFile = "case.json";
constexpr std::size_t kMostInAFlow = 100;  // in the flow of one case

// "[text](address)" would be a link.
Json message(std::string_view text) {
  std::string safe = escaped_block(text);
  for (std::size_t at = 0; (at = safe.find("](", at)) != std::string::npos;) safe.insert(at + 1, " ");
  return {{"text", safe.empty() ? "-" : safe}};
}

// A path as part of a URI.
std::string uri_path(std::string_view path) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
  std::string uri;
  for (const char c : path) {
    uri += kPlain.find(c) != std::string_view::npos ? std::string(1, c)
                                                    : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

struct Standing {
  std::string_view kind;
  std::string_view level;
};

Standing standing_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return {"pass", "none"};
    case Verdict::not_applicable:
      return {"notApplicable", "none"};
    case Verdict::warn:
      return {"fail", "warning"};
    case Verdict::fail:
    case Verdict::error:
      return {"fail", "error"};
    case Verdict::inconclusive:
    case Verdict::none:
      break;
  }
  return {"open", "none"};
}

Json rule_of(const CaseResult& result) {
  Json rule = {{"id", escaped_line(result.id)}};
  if (!result.purpose.empty()) rule["name"] = escaped_line(result.purpose);
  rule["shortDescription"] = message(result.requirement);
  rule["fullDescription"] = message(result.requirement);
  rule["properties"] = {{"source", escaped_line(result.reference.source)},
                        {"clause", escaped_line(result.reference.clause)},
                        {"standing", judge::name(result.reference.standing)},
                        {"verified", judge::is_verified(result.reference.standing)}};
  return rule;
}

// Where the result is stored; a service asks for a file of every place.
Json stored_at(const PageRun& run, const CaseResult& result) {
  const auto files = run.files.find(result.id);
  const bool has_case = files != run.files.end() && std::ranges::count(files->second, kCaseFile) > 0;
  const std::string file =
      has_case ? "cases/" + case_directory_name(result.id) + "/" + kCaseFile : "results.json";
  return {{"artifactLocation", {{"uri", uri_path(file)}, {"uriBaseId", "RUN"}}},
          {"region", {{"startLine", 1}}}};
}

// One entry of the time line of a case.
struct Moment {
  std::int64_t time_ps = 0;
  std::string_view importance;
  std::string kind;
  std::string text;
};

Json flow_location(const Moment& moment, std::size_t order, const Json& place) {
  const kernel::Time time = kernel::kStart + kernel::Duration(moment.time_ps);
  const std::string text = fmt::format("{}: {}: {}", kernel::describe(time), moment.kind, moment.text);
  return {{"location", {{"physicalLocation", place}, {"message", message(text)}}},
          {"executionOrder", order},
          {"importance", moment.importance},
          {"properties", {{"kind", moment.kind}, {"time_ps", std::to_string(moment.time_ps)}}}};
}

// 0 for what is none: the file may have been written by anybody.
std::int64_t number_in(const std::string& text) {
  std::int64_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

// `key` of a stored time line, the last ones before `until`.
void add_moments(std::vector<Moment>& moments, const Json& timeline, const char* key, const char* time,
                 const Moment& like, std::int64_t until) {
  std::vector<Moment> found;
  for (const Json& one : timeline.value(key, Json::array())) {
    Moment moment = like;
    moment.time_ps = number_in(one.at(time).get<std::string>());
    const std::size_t channel = one.value("channel", std::size_t{0});
    if (one.contains("channel") && channel < timeline.at("channels").size()) {
      moment.text = timeline["channels"][channel].at("name").get<std::string>() + ": ";
    }
    moment.text += one.at("text").get<std::string>();
    if (moment.time_ps <= until) found.push_back(std::move(moment));
  }
  const std::size_t first = found.size() - std::min(found.size(), kMostInAFlow);
  moments.insert(moments.end(), found.begin() + static_cast<std::ptrdiff_t>(first), found.end());
}

std::string finding_line(const judge::Finding& finding) {
  std::string text = finding.reason;
  if (!finding.step.empty()) text += " in step " + finding.step;
  if (!finding.expected.empty()) text += fmt::format("\nexpected: {}", fmt::join(finding.expected, " or "));
  text += "\nactual: " + finding.actual;
  if (!finding.first_difference.empty()) text += "\nfirst difference: " + finding.first_difference;
  for (const std::string& line : finding.decisive) text += "\ndecisive: " + line;
  return text;
}

std::string with_decode(const judge::Finding& finding) {
  std::string text = finding_line(finding);
  for (const std::string& line : finding.decode) text += "\n" + line;
  return text;
}

std::vector<Moment> moments_of(const PageRun& run, const CaseResult& result) {
  std::vector<Moment> moments;
  std::int64_t last = 0;
  for (const judge::Finding& finding : result.findings) {
    last = std::max(last, finding.time.time_since_epoch().count());
  }
  if (const auto stored = run.timelines.find(result.id); stored != run.timelines.end()) {
    const Json timeline = Json::parse(stored->second);
    add_moments(moments, timeline, "steps", "time_ps", {0, "important", "step", {}}, last);
    add_moments(moments, timeline, "faults", "time_ps", {0, "important", "fault", {}}, last);
    add_moments(moments, timeline, "transmissions", "start_ps", {0, "unimportant", "transmission", {}}, last);
  }
  for (const judge::Finding& finding : result.findings) {
    moments.push_back(
        {finding.time.time_since_epoch().count(), "essential", "finding", with_decode(finding)});
  }
  std::ranges::stable_sort(moments, {}, &Moment::time_ps);
  return moments;
}

Json code_flows(const PageRun& run, const CaseResult& result, const Json& place) {
  Json locations = Json::array();
  for (const Moment& moment : moments_of(run, result)) {
    locations.push_back(flow_location(moment, locations.size() + 1, place));
  }
  if (locations.empty()) return Json::array();
  const Json thread = {{"id", "virtual time"}, {"locations", std::move(locations)}};
  return Json::array({{{"threadFlows", Json::array({thread})}}});
}

Json result_of(const PageRun& run, const CaseResult& result, std::size_t rule) {
  const Standing standing = standing_of(result.verdict);
  std::string text = verdict_message(result);
  if (!result.findings.empty()) text += "\n" + finding_line(result.findings.front());
  text += "\nreproduce: " + reproduce_command(run.stored.run.identity, result.id);
  const Json place = stored_at(run, result);
  const Json names = Json::array({{{"fullyQualifiedName", escaped_line(result.id)}}});
  Json json = {
      {"ruleId", escaped_line(result.id)},
      {"ruleIndex", rule},
      {"kind", standing.kind},
      {"level", standing.level},
      {"message", message(text)},
      {"locations", Json::array({{{"physicalLocation", place}, {"logicalLocations", names}}})},
      {"partialFingerprints", {{"caseAndReason/v1", escaped_line(result.id + "#" + result.reason)}}}};
  if (Json flows = code_flows(run, result, place); !flows.empty()) json["codeFlows"] = std::move(flows);
  if (counted_verdict(result) != result.verdict) {
    json["suppressions"] = Json::array({{{"kind", "external"},
                                         {"status", "accepted"},
                                         {"justification", escaped_line(result.expected_because)}}});
  }
  json["properties"] = {{"verdict", name(result.verdict)}, {"reason", escaped_line(result.reason)}};
  return json;
}

Json invocation_of(const StoredRun& stored) {
  Json notifications = Json::array();
  for (const Complaint& complaint : complaints_about(stored.run, {})) {
    notifications.push_back(
        {{"descriptor", {{"id", complaint.name}}}, {"level", "error"}, {"message", message(complaint.text)}});
  }
  Json invocation = {{"executionSuccessful", notifications.empty()},
                     {"exitCode", stored.run.identity.exit_code}};
  if (utc_milliseconds(stored.manifest.started)) invocation["startTimeUtc"] = stored.manifest.started;
  if (utc_milliseconds(stored.manifest.finished)) invocation["endTimeUtc"] = stored.manifest.finished;
  if (!notifications.empty()) invocation["toolExecutionNotifications"] = std::move(notifications);
  return invocation;
}

}  // namespace

std::string sarif_json(const PageRun& run) {
  const RunIdentity& identity = run.stored.run.identity;
  Json rules = Json::array();
  Json results = Json::array();
  for (const CaseResult& result : run.stored.run.cases) {
    if (result.verdict != Verdict::pass && result.verdict != Verdict::not_applicable) {
      results.push_back(result_of(run, result, rules.size()));
    }
    rules.push_back(rule_of(result));
  }
  const Json driver = {
      {"name", "fieldproof"}, {"version", escaped_line(identity.tool_version)}, {"rules", std::move(rules)}};
  const Json bases = {{"RUN", {{"description", message("The directory of the run.")}}}};
  const Json only = {
      {"tool", {{"driver", driver}}},
      {"invocations", Json::array({invocation_of(run.stored)})},
      {"originalUriBaseIds", bases},
      {"columnKind", "unicodeCodePoints"},
      {"results", std::move(results)},
      {"properties",
       {{"seed", std::to_string(identity.seed)}, {"suite_version", escaped_line(identity.suite_version)}}}};
  const Json log = {{"$schema", kSarifSchema}, {"version", "2.1.0"}, {"runs", Json::array({only})}};
  return log.dump(1) + "\n";
}

}  // namespace fieldproof::reports
