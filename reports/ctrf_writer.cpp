#include "reports/ctrf_writer.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "harness/judge/result_json.hpp"
#include "harness/kernel/time.hpp"
#include "reports/text_summary.hpp"
#include "reports/utc_time.hpp"

namespace fieldproof::reports {
namespace {

using judge::CaseResult;
using Json = nlohmann::ordered_json;

std::string_view status_of(Outcome outcome) {
  if (outcome == Outcome::passed) return "passed";
  return outcome == Outcome::skipped ? "skipped" : "failed";
}

constexpr std::uint64_t kUsPerMs = 1000;

std::string name_or(std::string_view text) {
  return text.empty() ? "-" : escaped_line(text);
}

// The folders that a case lies in.
Json suite_of_id(std::string_view id) {
  Json suite = Json::array();
  for (std::size_t end = 0; (end = id.find('/')) != std::string_view::npos; id.remove_prefix(end + 1)) {
    suite.push_back(name_or(id.substr(0, end)));
  }
  if (suite.empty()) suite.push_back("-");
  return suite;
}

Json lines_of(const std::string& text) {
  Json lines = Json::array();
  std::istringstream stream(escaped_block(text));
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

Json test_of(const RunIdentity& identity, const CaseResult& result, Outcome outcome) {
  Json test = {{"testId", name_or(result.id)},    {"name", name_or(result.id)},
               {"status", status_of(outcome)},    {"duration", result.wall_time_us / kUsPerMs},
               {"suite", suite_of_id(result.id)}, {"rawStatus", name(result.verdict)}};
  if (const std::string message = outcome_message(result); !message.empty()) {
    test["message"] = escaped_line(message);
  }
  if (result.verdict > judge::Verdict::pass) test["trace"] = finding_text(identity, result);
  if (!result.log.empty()) test["stderr"] = lines_of(result.log);
  test["extra"] = {{"purpose", escaped_line(result.purpose)},
                   {"requirement", escaped_block(result.requirement)},
                   {"source", escaped_line(result.reference.source)},
                   {"verified", judge::is_verified(result.reference.standing)},
                   {"seed", std::to_string(result.seed)},
                   {"reproduce", escaped_line(reproduce_command(identity, result.id))},
                   {"fingerprint", judge::fingerprint_text(result.fingerprint)},
                   {"virtual_time", kernel::describe(result.virtual_time)}};
  return test;
}

Json test_of(const Complaint& complaint) {
  return {{"name", complaint.name},
          {"status", status_of(complaint.outcome)},
          {"duration", 0},
          {"suite", Json::array({kComplaintSuite})},
          {"rawStatus", complaint.type},
          {"message", escaped_block(complaint.text)}};
}

Json summary_of(const Json& tests, const Manifest& manifest) {
  std::map<std::string, std::size_t> counts;
  for (const Json& test : tests) ++counts[test.at("status").get<std::string>()];
  const std::int64_t start = utc_milliseconds(manifest.started).value_or(0);
  return {{"tests", tests.size()},
          {"passed", counts["passed"]},
          {"failed", counts["failed"]},
          {"skipped", counts["skipped"]},
          {"pending", 0},
          {"other", 0},
          {"start", start},
          {"stop", start + static_cast<std::int64_t>(manifest.wall_time_us / kUsPerMs)}};
}

}  // namespace

std::string ctrf_json(const PageRun& run, const OutcomeRules& rules) {
  const RunIdentity& identity = run.stored.run.identity;
  Json tests = Json::array();
  for (const CaseResult& result : run.stored.run.cases) {
    tests.push_back(test_of(identity, result, outcome_of(result, rules)));
  }
  for (const Complaint& one : complaints_about(run.stored.run, rules)) tests.push_back(test_of(one));
  const Json tool = {
      {"name", "fieldproof"},
      {"version", escaped_line(identity.tool_version)},
      {"extra",
       {{"seed", std::to_string(identity.seed)}, {"suite_version", escaped_line(identity.suite_version)}}}};
  const Json summary = summary_of(tests, run.stored.manifest);
  const Json document = {{"reportFormat", "CTRF"},
                         {"specVersion", "0.0.0"},
                         {"results", {{"tool", tool}, {"summary", summary}, {"tests", std::move(tests)}}}};
  return document.dump(1) + "\n";
}

}  // namespace fieldproof::reports
