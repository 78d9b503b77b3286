#include "reports/ctrf_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "harness/judge/arbitrary_result.hpp"
#include "reports/published_schema.hpp"
#include "reports/sample_run.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::json;

constexpr const char* kPublishedCtrf = "ctrf/dist/ctrf-schema-0.0.json";

PageRun ctrf_sample() {
  PageRun run;
  run.stored = {sample_manifest(), sample_run(), false};
  return run;
}

TEST(CtrfWriter, WritesTheApprovedDocument) {
  expect_approved("ctrf.json", ctrf_json(ctrf_sample(), {}));
}

TEST(CtrfWriter, IsValidByThePublishedSchema) {
  expect_valid_by_published_schema(kPublishedCtrf, ctrf_json(ctrf_sample(), {}));
}

TEST(CtrfWriter, IsValidByThePublishedSchemaWithArbitraryText) {
  PageRun run = ctrf_sample();
  const auto cases = rc::gen::container<std::vector<judge::CaseResult>>(100, judge::arbitrary_result());
  run.stored.run.cases = cases(rc::Random(20240611), 30).value();
  run.stored.manifest.started = "\xff soon";
  expect_valid_by_published_schema(kPublishedCtrf, ctrf_json(run, {}));
}

TEST(CtrfWriter, GivesADashboardTheRightCounts) {
  const Json results = Json::parse(ctrf_json(ctrf_sample(), {})).at("results");
  std::map<std::string, std::string> statuses;
  std::map<std::string, int> counts;
  for (const Json& test : results.at("tests")) {
    const std::string name = test.at("name");
    statuses[name.substr(name.rfind('/') + 1)] = test.at("status");
    ++counts[test.at("status").get<std::string>()];
  }
  EXPECT_EQ(statuses, (std::map<std::string, std::string>{{"loopback_returns", "passed"},
                                                          {"outputs_are_kept", "failed"},
                                                          {"code_is_told", "passed"},
                                                          {"length_is_told", "failed"},
                                                          {"bus_is_left", "failed"},
                                                          {"branch_is_left", "skipped"},
                                                          {"none", "failed"},
                                                          {"is_complete", "failed"}}));
  EXPECT_EQ(results.at("summary").at("tests"), statuses.size());
  for (const auto& [status, number] : counts) EXPECT_EQ(results.at("summary").at(status), number) << status;
  EXPECT_EQ(results.at("summary").at("start"), 1767323045000);
  EXPECT_EQ(results.at("summary").at("stop"), 1767323045900);
}

}  // namespace
}  // namespace fieldproof::reports
