#include "reports/measurement_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/approved_text.hpp"
#include "reports/sample_measurement.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::json;

TEST(MeasurementWriter, WritesTheApprovedDocuments) {
  expect_approved("measurement.json", measurement_json(sample_measurement()));
  expect_approved("measurement.txt", measurement_text(sample_measurement()));
}

TEST(MeasurementWriter, IsValidForASchemaValidator) {
  const TemporaryFolder folder;
  measure::Measurement hostile = sample_measurement();
  hostile.network = "\x1b[31m\xff";
  hostile.series.clear();
  const auto good = folder.path() / "good.json";
  const auto odd = folder.path() / "odd.json";
  write_text_file(good, measurement_json(sample_measurement()));
  write_text_file(odd, measurement_json(hostile));
  const AjvJudgement judgement =
      judge_with_ajv(FIELDPROOF_SOURCE_DIR, schema_path("measurement"), {good, odd});
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.exit_code, 0) << judgement.output;
}

TEST(MeasurementWriter, SchemaRefusesWhatIsNoMeasurement) {
  const TemporaryFolder folder;
  Json broken = Json::parse(measurement_json(sample_measurement()));
  broken["series"][0]["comparisons"][0]["agreement"] = "good";
  const auto file = folder.path() / "broken.json";
  write_text_file(file, broken.dump());
  const AjvJudgement judgement = judge_with_ajv(FIELDPROOF_SOURCE_DIR, schema_path("measurement"), {file});
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  EXPECT_NE(judgement.exit_code, 0);
}

TEST(MeasurementWriter, DistributionsStandInTheirUnitAndByPhase) {
  const Json json = Json::parse(measurement_json(sample_measurement()));
  const Json& delays = json["series"][0]["distributions"][0];
  EXPECT_EQ(delays["unit"], "us");
  EXPECT_FALSE(delays["phases"].contains("recovery"));
  EXPECT_EQ(delays["phases"]["quiet"]["count"], 4);
  EXPECT_EQ(delays["phases"]["quiet"]["min"], 1.0);
  EXPECT_EQ(delays["phases"]["quiet"]["p50"], 2.0);
  EXPECT_EQ(delays["phases"]["burst"]["max"], 9.5);
  std::uint64_t in_bins = 0;
  for (const Json& bin : delays["phases"]["quiet"]["histogram"]) in_bins += bin["count"].get<std::uint64_t>();
  EXPECT_EQ(in_bins, 4U);
}

TEST(MeasurementWriter, ACourseSaysWhenValuesCame) {
  const Json json = Json::parse(measurement_json(sample_measurement()));
  const Json& course = json["series"][0]["course"];
  EXPECT_EQ(course["theory"], 814.0);
  const Json& run = course["runs"][0];
  EXPECT_EQ(run["length_s"], 1.0);
  EXPECT_EQ(run["window_s"], 0.02);
  EXPECT_EQ(run["stopped_s"], 0.9);
  ASSERT_EQ(run["bursts"].size(), 3U);
  EXPECT_EQ(run["bursts"][1]["from_s"], 0.4);
  EXPECT_EQ(run["bursts"][1]["to_s"], 0.425);
  EXPECT_EQ(run["bursts"][1]["count"], 2);
  // The longest cycle is the last one in the last burst.
  EXPECT_EQ(run["longest"][0]["at_s"], 0.72);
  EXPECT_EQ(run["longest"][0]["phase"], "burst");
  EXPECT_EQ(run["longest"][0]["value"], 814.0 + 814 + 40 * 72);
  const auto points = run["points"];
  const auto burst = std::ranges::find_if(
      points, [](const Json& point) { return point["from_s"] == 0.42 && point["phase"] == "burst"; });
  ASSERT_NE(burst, points.end());
  EXPECT_EQ((*burst)["count"], 1);
  EXPECT_EQ((*burst)["max"], 814.0 + 814 + 40 * 42);
}

TEST(MeasurementWriter, TheTextNamesTheLongestUnlessAllAreEqual) {
  measure::Measurement measurement = sample_measurement();
  EXPECT_NE(
      measurement_text(measurement).find("longest cycle time, 50 Hz: 4508.000 us at 0.720000 s (burst)"),
      std::string::npos);
  auto& values = measurement.series[0].course->runs[0].values;
  values = measure::TimeCourse(kernel::kSecond, 10);
  for (int n = 0; n < 10; ++n) values.add(n * 100 * kernel::kMillisecond, measure::Phase::quiet, 814'000'000);
  EXPECT_EQ(measurement_text(measurement).find("longest cycle time"), std::string::npos);
}

TEST(MeasurementWriter, TextOfAFileNeverReachesTheTerminalAsAControl) {
  measure::Measurement hostile = sample_measurement();
  hostile.network = "a\x1b[31mb\nc";
  hostile.series[0].name = "\x1b]0;x\x07";
  const std::string text = measurement_text(hostile);
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_EQ(text.find('\x07'), std::string::npos);
}

TEST(MeasurementWriter, CaveatsStandApartFromConditions) {
  const auto json = nlohmann::json::parse(measurement_json(sample_burst_measurement()));
  EXPECT_EQ(json.at("unverified"), nlohmann::json({"The coupling is not calibrated."}));
  for (const auto& one : json.at("conditions")) EXPECT_NE(one.at("name"), "unverified");
  EXPECT_FALSE(nlohmann::json::parse(measurement_json(sample_measurement())).contains("unverified"));
}

TEST(MeasurementWriter, TextSaysWhichRowsDiffer) {
  measure::Measurement measurement = sample_measurement();
  EXPECT_NE(measurement_text(measurement).find("theory and measurement: holds"), std::string::npos);
  measurement.series[0].comparisons[0].measured *= 2;
  const std::string text = measurement_text(measurement);
  EXPECT_NE(text.find("theory and measurement: differs"), std::string::npos);
  EXPECT_NE(text.find("% of the theory  differs"), std::string::npos) << text;
}

TEST(MeasurementWriter, ATraceIsDrawnInColumns) {
  measure::Trace trace;
  trace.length = 10 * kernel::kMillisecond;
  trace.input = {{2 * kernel::kMillisecond, true}, {5 * kernel::kMillisecond, false}};
  trace.output = {{9 * kernel::kMillisecond, true}};
  EXPECT_EQ(trace_text(trace, 10), "input  __###_____\noutput _________#\n");
  EXPECT_EQ(trace_text(measure::Trace{}, 3), "input  ___\noutput ___\n");
}

}  // namespace
}  // namespace fieldproof::reports
