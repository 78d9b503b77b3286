#include "reports/sarif_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>

#include "harness/judge/arbitrary_result.hpp"
#include "harness/kernel/arbitrary_text.hpp"
#include "reports/published_schema.hpp"
#include "reports/sample_run.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::json;

constexpr const char* kPublished = "@microsoft/jest-sarif/lib/schemas/sarif-2.1.0-rtm.5.json";

PageRun sarif_sample() {
  PageRun run;
  run.stored = {sample_manifest(), sample_run(), false};
  const std::string caught = sample_failure().id;
  run.timelines.emplace(caught, read_text_file(approved_path("timeline.json")));
  run.files.emplace(caught, std::vector<std::string>{"case.json", "timeline.json"});
  return run;
}

Json only_run(const PageRun& run) {
  return Json::parse(sarif_json(run)).at("runs").at(0);
}

const Json* result_of_case(const Json& run, const std::string& end) {
  for (const Json& one : run.at("results")) {
    if (one.at("ruleId").get<std::string>().ends_with(end)) return &one;
  }
  return nullptr;
}

TEST(SarifWriter, WritesTheApprovedDocument) {
  expect_approved("ci.sarif", sarif_json(sarif_sample()));
}

TEST(SarifWriter, IsValidByThePublishedSchema) {
  expect_valid_by_published_schema(kPublished, sarif_json(sarif_sample()));
}

TEST(SarifWriter, IsValidByThePublishedSchemaWithArbitraryText) {
  PageRun run = sarif_sample();
  const auto cases = rc::gen::container<std::vector<judge::CaseResult>>(100, judge::arbitrary_result());
  run.stored.run.cases = cases(rc::Random(20240611), 30).value();
  for (std::size_t n = 0; n < run.stored.run.cases.size(); ++n)
    run.stored.run.cases[n].id += std::to_string(n);
  run.stored.manifest.started = "\xff soon";
  expect_valid_by_published_schema(kPublished, sarif_json(run));
}

TEST(SarifWriter, HasARuleForEachRequirementAndAResultForWhatDoesNotPass) {
  const Json run = only_run(sarif_sample());
  EXPECT_EQ(run.at("tool").at("driver").at("rules").size(), 7U);
  EXPECT_EQ(run.at("results").size(), 5U);
  EXPECT_EQ(result_of_case(run, "loopback_returns"), nullptr);
  EXPECT_EQ(result_of_case(run, "branch_is_left"), nullptr);
  for (const Json& one : run.at("results")) {
    const Json& rule = run.at("tool").at("driver").at("rules").at(one.at("ruleIndex").get<std::size_t>());
    EXPECT_EQ(rule.at("id"), one.at("ruleId"));
    EXPECT_FALSE(rule.at("fullDescription").at("text").get<std::string>().empty());
  }
  const std::map<std::string, std::pair<std::string, std::string>> expected = {
      {"outputs_are_kept", {"fail", "error"}},
      {"code_is_told", {"fail", "warning"}},
      {"length_is_told", {"open", "none"}},
      {"bus_is_left", {"fail", "error"}},
      {"stop/none", {"open", "none"}}};
  for (const auto& [end, standing] : expected) {
    const Json* one = result_of_case(run, end);
    ASSERT_NE(one, nullptr) << end;
    EXPECT_EQ(one->at("kind"), standing.first) << end;
    EXPECT_EQ(one->at("level"), standing.second) << end;
  }
}

TEST(SarifWriter, TellsTheTimeLineAsAThreadFlow) {
  const Json run = only_run(sarif_sample());
  const Json& caught = *result_of_case(run, "outputs_are_kept");
  EXPECT_EQ(caught["locations"][0]["physicalLocation"]["artifactLocation"]["uri"],
            "cases/interbus%2Bslave%2Bdata_cycle%2Boutputs_are_kept/case.json");
  const Json& flow = caught.at("codeFlows").at(0).at("threadFlows").at(0).at("locations");
  std::map<std::string, int> kinds;
  std::int64_t last = 0;
  for (const Json& one : flow) {
    const std::int64_t time = std::stoll(one.at("properties").at("time_ps").get<std::string>());
    EXPECT_GE(time, last);
    last = time;
    ++kinds[one.at("properties").at("kind").get<std::string>()];
  }
  EXPECT_EQ(kinds,
            (std::map<std::string, int>{{"step", 2}, {"fault", 3}, {"transmission", 4}, {"finding", 1}}));
  EXPECT_EQ(flow.back().at("importance"), "essential");
}

TEST(SarifWriter, SuppressesWhatTheBaselineExpects) {
  PageRun run = sarif_sample();
  run.stored.run.cases[1].expected_because = "slow driver, until 2099-01-01";
  const Json suppressions = result_of_case(only_run(run), "outputs_are_kept")->at("suppressions");
  EXPECT_EQ(suppressions.at(0).at("justification"), "slow driver, until 2099-01-01");
}

TEST(SarifWriter, TellsWhatIsWrongWithTheRun) {
  PageRun run = sarif_sample();
  const Json incomplete = only_run(run).at("invocations").at(0);
  EXPECT_EQ(incomplete.at("executionSuccessful"), false);
  EXPECT_EQ(incomplete.at("toolExecutionNotifications").size(), 1U);
  run.stored.run.identity.incomplete_because.clear();
  EXPECT_EQ(only_run(run).at("invocations").at(0).at("executionSuccessful"), true);
}

TEST(SarifWriter, MakesNoLinkOfAnyText) {
  PageRun run = sarif_sample();
  run.stored.run.cases[1].findings[0].actual = "[a link](http://example.org) \x1b[2J \xe2\x80\xae";
  const std::string text = sarif_json(run);
  EXPECT_EQ(text.find("]("), std::string::npos);
  EXPECT_EQ(text.find("\xe2\x80\xae"), std::string::npos);
  EXPECT_EQ(text.find("\\u001b"), std::string::npos);
}

// A time line may have been written by anybody.
TEST(SarifWriter, TakesTimesThatAreNone) {
  PageRun run = sarif_sample();
  std::string& timeline = run.timelines.begin()->second;
  timeline.replace(timeline.find("\"0\""), 3, "\"99999999999999999999999\"");
  EXPECT_FALSE(sarif_json(run).empty());
}

}  // namespace
}  // namespace fieldproof::reports
