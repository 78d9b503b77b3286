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

std::string sentence_of(const Json& json) {
  try {
    case_result_from(json, "journal.jsonl:7");
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::configuration);
    return error.what();
  }
  return "no error";
}

RC_GTEST_PROP(ResultJson, ReadsBackWhatItWrote, ()) {
  const CaseResult result = *arbitrary_result();
  const std::string written = to_json(result, WallTime::included).dump();
  const CaseResult read = case_result_from(Json::parse(written), "test");
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
  const CaseResult read = case_result_from(to_json(result, WallTime::apart), "test");
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
  EXPECT_EQ(case_result_from(json, "test").id, "interbus/slave/data_cycle/x");
}

TEST(ResultJson, SaysWhatIsWrongAndWhatWouldBeRight) {
  Json json = sample();
  json["verdict"] = "passed";
  EXPECT_EQ(
      sentence_of(json),
      "journal.jsonl:7: \"verdict\" must be one of none, not-applicable, pass, warn, inconclusive, fail, "
      "error");
  json = sample();
  json["seed"] = 12;
  EXPECT_EQ(sentence_of(json), "journal.jsonl:7: \"seed\" must be a string");
  json["seed"] = "18446744073709551616";
  EXPECT_EQ(sentence_of(json), "journal.jsonl:7: \"seed\" must be a string with a decimal 64-bit integer");
  json["seed"] = "12 ";
  EXPECT_EQ(sentence_of(json), "journal.jsonl:7: \"seed\" must be a string with a decimal 64-bit integer");
  json = sample();
  json["fingerprint"] = "xyz";
  EXPECT_EQ(sentence_of(json),
            "journal.jsonl:7: \"fingerprint\" must be a string with a hexadecimal 64-bit integer");
  json = sample();
  json["measurements"][0]["high"] = "much";
  EXPECT_EQ(sentence_of(json),
            "journal.jsonl:7: measurements/0: \"high\" must be a number, \"nan\", \"inf\" or \"-inf\"");
  json = sample();
  json["findings"][0]["reference"]["standing"] = "rumour";
  EXPECT_EQ(sentence_of(json),
            "journal.jsonl:7: findings/0: reference: \"standing\" must be one of seed, sure, searched, calc, "
            "derived, memory, own");
  json = sample();
  json["findings"][0]["expected"] = {1};
  EXPECT_EQ(sentence_of(json), "journal.jsonl:7: findings/0: \"expected\" must be a list of strings");
  json = sample();
  json["findings"] = 3;
  EXPECT_EQ(sentence_of(json), "journal.jsonl:7: \"findings\" must be a list");
  json = sample();
  json.erase("log");
  EXPECT_EQ(sentence_of(json), "journal.jsonl:7: \"log\" must be present");
  EXPECT_EQ(sentence_of(Json::array()), "journal.jsonl:7: the result of a case must be an object");
}

}  // namespace
}  // namespace fieldproof::judge
