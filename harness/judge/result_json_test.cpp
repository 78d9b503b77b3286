#include "harness/judge/result_json.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "harness/judge/arbitrary_result.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::judge {
namespace {

using Json = nlohmann::ordered_json;

Json sample() {
  CaseResult result;
  result.id = "interbus/slave/data_cycle/x";
  result.verdict = Verdict::fail;
  result.findings.emplace_back();
  result.measurements.push_back({"cycle_time", "us", 755.0, 754.0, 756.0});
  return to_json(result, WallTime::included);
}

CaseResult read_again(const std::string& text) {
  const config::Document document = config::Document::parse(text, "journal.jsonl:7");
  return case_result_from(document.root());
}
CaseResult read_again(const Json& json) {
  return read_again(json.dump());
}

std::string sentence_of(const Json& json) {
  try {
    read_again(json);
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    return error.what();
  }
  return "no error";
}

void expect_refused(const Json& json, std::string_view pointer, std::string_view sentence) {
  const std::string error = sentence_of(json);
  EXPECT_TRUE(error.starts_with("journal.jsonl:7:1: " + std::string(pointer) + ": ")) << error;
  EXPECT_NE(error.find(sentence), std::string::npos) << error;
}

RC_GTEST_PROP(ResultJson, ReadsBackWhatItWrote, ()) {
  const CaseResult result = *arbitrary_result();
  const std::string written = to_json(result, WallTime::included).dump();
  const CaseResult read = read_again(written);
  RC_ASSERT(to_json(read, WallTime::included).dump() == written);
  RC_ASSERT(read.seed == result.seed);
  RC_ASSERT(read.fingerprint == result.fingerprint);
  RC_ASSERT(read.virtual_time == result.virtual_time);
  RC_ASSERT(read.wall_time_us == result.wall_time_us);
  RC_ASSERT(read.verdict == result.verdict);
  for (std::size_t i = 0; i < result.measurements.size(); ++i) {
    const double wrote = result.measurements.at(i).value;
    const double reread = read.measurements.at(i).value;
    RC_ASSERT((std::isnan(wrote) ? std::isnan(reread) : reread == wrote));
  }
}

TEST(ResultJson, KeepsValidTextAsItIs) {
  CaseResult result;
  result.reason = std::string("\x1b[31m \0 \xe2\x82\xac \\x41", 14);
  result.purpose = "IS-14";
  const CaseResult read = read_again(to_json(result, WallTime::apart));
  EXPECT_EQ(read.reason, result.reason);
  EXPECT_EQ(read.purpose, "IS-14");
}

TEST(ResultJson, LeavesTheWallTimeOutWhenAsked) {
  CaseResult result;
  result.wall_time_us = 17;
  EXPECT_FALSE(to_json(result, WallTime::apart).contains("wall_time_us"));
  EXPECT_EQ(to_json(result, WallTime::included).at("wall_time_us"), "17");
}

TEST(ResultJson, SkipsKeysOfALaterVersion) {
  Json json = sample();
  json["colour"] = "blue";
  EXPECT_EQ(read_again(json).id, "interbus/slave/data_cycle/x");
}

TEST(ResultJson, SaysWhereWhatIsWrongAndWhatWouldBeRight) {
  Json json = sample();
  json["verdict"] = "passed";
  expect_refused(json, "/verdict", "none, not-applicable, pass, warn, inconclusive, fail, error");
  json = sample();
  for (const Json& seed : {Json(12), Json("18446744073709551616"), Json("12 "), Json("")}) {
    json["seed"] = seed;
    expect_refused(json, "/seed", seed.is_string() ? "no decimal 64-bit integer" : "write a string");
  }
  json = sample();
  json["fingerprint"] = "xyz";
  expect_refused(json, "/fingerprint", "no hexadecimal 64-bit integer");
  json = sample();
  json["measurements"][0]["high"] = "much";
  expect_refused(json, "/measurements/0/high", R"("nan", "inf", "-inf")");
  json = sample();
  json["findings"][0]["reference"]["standing"] = "rumour";
  expect_refused(json, "/findings/0/reference/standing", "derived, memory, own");
  json = sample();
  json["findings"][0]["expected"] = {1};
  expect_refused(json, "/findings/0/expected/0", "write a string");
  json = sample();
  json["findings"] = 3;
  expect_refused(json, "/findings", "write an array");
  json = sample();
  json.erase("log");
  expect_refused(json, "the top level", "\"log\" is missing");
  expect_refused(Json::array(), "the top level", "write an object");
}

}  // namespace
}  // namespace fieldproof::judge
