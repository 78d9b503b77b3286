#include "reports/json_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "harness/judge/arbitrary_result.hpp"
#include "harness/judge/journal.hpp"
#include "harness/kernel/arbitrary_text.hpp"
#include "harness/kernel/error.hpp"
#include "reports/approved_text.hpp"
#include "reports/diff.hpp"
#include "reports/sample_run.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::reports {
namespace {

using Json = nlohmann::json;

const Json& schema_of(const std::string& name) {
  static std::map<std::string, Json> read;
  const auto [found, is_new] = read.try_emplace(name);
  if (is_new) found->second = Json::parse(read_text_file(schema_path(name)));
  return found->second;
}

// Walks a document along its schema: every key is listed, every required key is there. It resolves what the
// schemas of this folder use: $ref, properties, items, additionalProperties, allOf.
class KeyCheck {
 public:
  explicit KeyCheck(const std::string& name) : name_(name) {}

  std::vector<std::string> wrong(const Json& document) {
    walk(document, schema_of(name_), name_, "");
    return wrong_;
  }

 private:
  void walk(const Json& value, const Json& schema, const std::string& file, const std::string& at) {
    if (schema.contains("$ref")) return follow(value, schema.at("$ref").get<std::string>(), file, at);
    if (schema.contains("allOf")) walk(value, schema.at("allOf").at(0), file, at);
    for (const Json& key : schema.value("required", Json::array())) {
      if (!value.contains(key.get<std::string>())) wrong_.push_back(at + " lacks " + key.get<std::string>());
    }
    if (value.is_array() && schema.contains("items")) {
      for (const Json& item : value) walk(item, schema.at("items"), file, at + "/*");
    }
    if (value.is_object() && !schema.contains("allOf")) walk_members(value, schema, file, at);
  }

  void walk_members(const Json& value, const Json& schema, const std::string& file, const std::string& at) {
    const Json listed = schema.value("properties", Json::object());
    for (const auto& [key, member] : value.items()) {
      if (listed.contains(key)) {
        walk(member, listed.at(key), file, at + "/" + key);
      } else if (!schema.contains("additionalProperties")) {
        wrong_.push_back(at + " has the unlisted " + key);
      }
    }
  }

  void follow(const Json& value, const std::string& reference, const std::string& file,
              const std::string& at) {
    const std::size_t cut = reference.find('#');
    const std::string target = cut == 0 ? file : "results";
    walk(value, schema_of(target).at(Json::json_pointer(reference.substr(cut + 1))), target, at);
  }

  std::string name_;
  std::vector<std::string> wrong_;
};

struct Written {
  std::string schema;
  std::string text;
};

std::vector<Written> every_document() {
  const reports::Run run = sample_run();
  reports::Run later = run;
  later.cases.erase(later.cases.begin() + 2);
  later.cases.at(0).verdict = judge::Verdict::fail;
  later.cases.at(0).fingerprint = 1;
  later.cases.at(1).verdict = judge::Verdict::pass;
  later.cases.at(1).measurements.at(0).value = 800;
  later.cases.at(2).reason = "other";
  later.cases.push_back(sample_case("new", judge::Verdict::pass));
  const TemporaryFolder folder;
  judge::Journal(folder.path() / "journal").append(run.cases.at(1));
  return {{"results", results_json(run)},
          {"manifest", manifest_json(sample_manifest(), run)},
          {"timings", timings_json(sample_manifest(), run)},
          {"diff", diff_json(compare(run, later))},
          {"journal", read_text_file(folder.path() / "journal")}};
}

TEST(JsonWriter, WritesTheKeysThatItsSchemasList) {
  for (const Written& document : every_document()) {
    EXPECT_EQ(KeyCheck(document.schema).wrong(Json::parse(document.text)), std::vector<std::string>{})
        << document.schema;
  }
}

TEST(JsonWriter, KeyCheckSeesAMissingAndAnUnlistedKey) {
  Json results = Json::parse(results_json(sample_run()));
  results["cases"][0].erase("verdict");
  results["run"]["colour"] = 1;
  EXPECT_EQ(KeyCheck("results").wrong(results),
            (std::vector<std::string>{"/cases/* lacks verdict", "/run has the unlisted colour"}));
}

TEST(JsonWriter, IsValidForASchemaValidator) {
  const TemporaryFolder folder;
  for (const Written& document : every_document()) {
    const auto file = folder.path() / (document.schema + ".json");
    write_text_file(file, document.text);
    const AjvJudgement judgement =
        judge_with_ajv(FIELDPROOF_SOURCE_DIR, schema_path(document.schema), {file});
    if (!judgement.is_available) GTEST_SKIP() << judgement.output;
    EXPECT_EQ(judgement.exit_code, 0) << judgement.output;
  }
}

TEST(JsonWriter, WritesTheApprovedDocuments) {
  expect_approved("results.json", results_json(sample_run()));
  expect_approved("manifest.json", manifest_json(sample_manifest(), sample_run()));
}

TEST(JsonWriter, ResultsDoNotKnowTheOccasion) {
  const reports::Run run = sample_run();
  reports::Run again = run;
  for (judge::CaseResult& result : again.cases) result.wall_time_us += 77;
  EXPECT_EQ(results_json(run), results_json(again));
  EXPECT_NE(timings_json(sample_manifest(), run), timings_json(sample_manifest(), again));
}

RC_GTEST_PROP(JsonWriter, ReadsBackWhatItWrote, ()) {
  reports::Run run = sample_run();
  run.cases.push_back(*rc::gen::scale(0.3, judge::arbitrary_result()));
  run.identity.incomplete_because = *kernel::arbitrary_text();
  run.identity.reproduce_options = *kernel::arbitrary_text();
  run.identity.seed = *judge::arbitrary_word();
  run.identity.caveats = {*kernel::arbitrary_text(), "b"};
  const std::string text = results_json(run);
  const reports::Run read = run_from_json(text, "test");
  RC_ASSERT(results_json(read) == text);
  RC_ASSERT(read.identity.seed == run.identity.seed);
  RC_ASSERT(read.identity.caveats.size() == 2 && read.identity.caveats[1] == "b");
  RC_ASSERT(KeyCheck("results").wrong(Json::parse(text)).empty());
}

TEST(JsonWriter, ReadsBackManifestAndTimings) {
  const reports::Run run = sample_run();
  const Manifest read = manifest_from_json(manifest_json(sample_manifest(), run), "test");
  EXPECT_EQ(manifest_json(read, run), manifest_json(sample_manifest(), run));
  reports::Run without = run_from_json(results_json(run), "test");
  EXPECT_EQ(without.cases.at(0).wall_time_us, 0U);
  add_timings(timings_json(sample_manifest(), run), "test", without);
  EXPECT_EQ(without.cases.at(0).wall_time_us, 1'250U);
}

std::string sentence_of(const std::string& text) {
  try {
    run_from_json(text, "x/results.json");
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.exit_code(), 65);
    return error.what();
  }
  return "no error";
}

TEST(JsonWriter, RefusesWhatIsNoResult) {
  const auto expect_refused = [](const std::string& text, const std::string& part) {
    const std::string sentence = sentence_of(text);
    EXPECT_TRUE(sentence.starts_with("x/results.json:")) << sentence;
    EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
  };
  expect_refused("[]", "write an object");
  expect_refused("{", "x/results.json:1:");
  expect_refused(R"({"schema":"fieldproof/results/2"})",
                 "this program reads \"schema\": \"fieldproof/results/1\", the file has "
                 "\"fieldproof/results/2\"");
  for (const std::string& nest : {std::string(100'000, '['), std::string(65, '[')}) {
    expect_refused(R"({"schema":"fieldproof/results/1","cases":)" + nest, "inside each other");
  }
  Json results = Json::parse(results_json(sample_run()));
  results["cases"][2]["verdict"] = "good";
  expect_refused(results.dump(), "/cases/2/verdict: ");
  results = Json::parse(results_json(sample_run()));
  results["run"].erase("selected");
  expect_refused(results.dump(), "/run: key \"selected\" is missing");
  for (const auto& [key, value] : {std::pair<const char*, Json>{"selected", -1},
                                   {"selected", 1e9},
                                   {"exit_code", 1e300},
                                   {"exit_code", 256},
                                   {"exit_code", -1}}) {
    results = Json::parse(results_json(sample_run()));
    results["run"][key] = value;
    expect_refused(results.dump(), std::string("/run/") + key + ": ");
  }
  results = Json::parse(results_json(sample_run()));
  results["cases"].push_back(results["cases"][0]);
  expect_refused(results.dump(), "already; remove one of the two");
}

}  // namespace
}  // namespace fieldproof::reports
