// Subject: the schemas that editors use and the readers of the same documents, which must judge alike. What
// only a reader can refuse (a duration that is not a whole number of picoseconds, a name that nobody knows)
// is kept apart, so that the day a schema learns it is seen.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/baseline.hpp"
#include "cli/campaign_plan.hpp"
#include "cli/matrix_text.hpp"
#include "cli/named_schemas.hpp"
#include "cli/options.hpp"
#include "cli/pics_file.hpp"
#include "cli/probe/source_folder.hpp"
#include "cli/protocols.hpp"
#include "cli/sequence_file.hpp"
#include "cli/settings.hpp"
#include "conformance/catalogue.hpp"
#include "emc/plan_disturbances.hpp"
#include "harness/fault/plan_file.hpp"
#include "harness/kernel/error.hpp"
#include "reports/approved_text.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

// A document and who takes it.
struct Sample {
  std::string text;
  bool reader_takes = true;
  bool schema_takes = true;
};

Sample good(std::string text) {
  return {std::move(text), true, true};
}
Sample bad(std::string text) {
  return {std::move(text), false, false};
}
Sample bad_to_the_reader_only(std::string text) {
  return {std::move(text), false, true};
}

class Schemas : public testing::Test {
 protected:
  void expect_alike(const fs::path& schema, const std::vector<Sample>& samples,
                    const std::function<void(const fs::path&)>& read) {
    std::vector<fs::path> files;
    for (const Sample& sample : samples) {
      files.push_back(folder_ / (std::to_string(files.size()) + ".json"));
      std::ofstream(files.back()) << sample.text;
      const std::optional<std::string> refusal = refusal_of(read, files.back());
      EXPECT_EQ(!refusal, sample.reader_takes) << sample.text << " " << refusal.value_or("");
    }
    const auto judgement = reports::judge_with_ajv(kSourceFolder, kSourceFolder / schema, files);
    if (!judgement.is_available) GTEST_SKIP() << judgement.output;
    std::istringstream lines(judgement.output);
    std::string line;
    for (std::size_t n = 0; n < samples.size(); ++n) {
      ASSERT_TRUE(std::getline(lines, line)) << judgement.output;
      EXPECT_EQ(line.find(": valid") != std::string::npos, samples[n].schema_takes) << samples[n].text << "\n"
                                                                                    << line;
    }
  }

  static std::optional<std::string> refusal_of(const std::function<void(const fs::path&)>& read,
                                               const fs::path& file) {
    try {
      read(file);
    } catch (const kernel::Error& error) {
      return error.what();
    }
    return std::nullopt;
  }

  const reports::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

const conformance::Catalogue& catalogue() {
  static const conformance::Catalogue catalogue(built_in_suites());
  return catalogue;
}

std::string when(const std::string& members) {
  return R"({"rules": [{"effect": {"drop": {}}, "when": {)" + members + "}}]}";
}
std::string effect(const std::string& members) {
  return R"({"rules": [{"effect": {)" + members + "}}]}";
}

std::string disturbance(const std::string& members) {
  return R"({"disturbances": [{)" + members + "}]}";
}

TEST_F(Schemas, OfAPlan) {
  const auto telegrams = line::TelegramCode(line::TelegramLayout{});
  expect_alike(
      "harness/fault/plan.schema.json",
      {good(when(R"("frame_number": 1)")),
       bad(when(R"("frame_number": 0)")),
       good(when(R"("frame_number": {"from": 1, "to": 1, "every": 1})")),
       bad(when(R"("frame_number": {"from": 0})")),
       bad(when(R"("frame_number": {"to": 0})")),
       good(when(R"("unit": 0)")),
       good(when(R"("unit": {"to": 0})")),
       bad(when(R"("unit": {"every": 0})")),
       bad_to_the_reader_only(when(R"("unit": {"from": 2, "to": 1})")),
       good(when(R"("from": "0 s", "to": "1 ps")")),
       bad(when(R"("to": "0 s")")),
       bad(when(R"("from": "-0 s")")),
       bad_to_the_reader_only(when(R"("from": "99999999999 s")")),
       good(R"({"rules": [{"effect": {"drop": {}}, "times": 3}]})"),
       bad(R"({"rules": [{"effect": {"drop": {}}, "times": 0}]})"),
       bad_to_the_reader_only(R"({"rules": [{"effect": {"drop": {}}, "times": 3.0}]})"),
       bad_to_the_reader_only(R"({"rules": [{"effect": {"drop": {}}, "times": 18446744073709551616}]})"),
       good(effect(R"("force": {"level": 1, "count": 4294967295})")),
       bad(effect(R"("force": {"level": 1, "count": 4294967296})")),
       bad(effect(R"("force": {"level": 1, "duration": "0.0 s"})")),
       good(effect(R"("delay": {"duration": "1 ps"})")),
       good(effect(R"("delay": {"duration": "1000000 s"})")),
       bad(effect(R"("delay": {"duration": "0 us"})")),
       bad(effect(R"("delay": {"duration": "0.5 ps"})")),
       bad_to_the_reader_only(effect(R"("delay": {"duration": "0.0001 ns"})")),
       bad_to_the_reader_only(effect(R"("delay": {"duration": "1000001 s"})")),
       good(effect(R"("repeat": {"gap": "0 us"})")),
       bad(effect(R"("repeat": {"gap": "-0 us"})")),
       good(effect(R"("insert": {"telegram": {"data": "0x005A"}})")),
       bad(effect(R"("insert": {"telegram": {"data": "0x15A"}})")),
       bad(effect(R"("insert": {"telegram": {"data": 256}})")),
       bad("{}"),
       good(R"({"disturbances": []})"),
       bad(disturbance("")),
       good(disturbance(R"("receiver": "a*", "from": "0 s", "to": "1 ps", "bursts": {"level": 4})")),
       bad_to_the_reader_only(disturbance(R"("from": "2 s", "to": "1 s", "bursts": {"level": 4})")),
       bad(disturbance(R"("bursts": {"level": 4}, "binary_symmetric": {"flip_probability": 0})")),
       bad(disturbance(R"("bursts": {"level": 5})")),
       bad(disturbance(R"("bursts": {"level": 4, "volts": 4})")),
       bad(disturbance(R"("bursts": {"volts": 0.5})")),
       good(disturbance(
           R"("bursts": {"volts": 4500, "repetition": "2.5kHz", "polarity": "-", "profile": "B2"})")),
       bad(disturbance(R"("bursts": {"level": 1, "profile": "b2"})")),
       good(disturbance(R"("bursts": {"level": 1, "profile": {"name": "line_7", "based_on": "C"}})")),
       bad(disturbance(R"("bursts": {"level": 1, "profile": {"title": "no name"}})")),
       bad_to_the_reader_only(disturbance(R"("bursts": {"level": 1, "profile": {"name": "A"}})")),
       good(disturbance(R"("bursts": {"level": 1, "first_burst": "1 s"})")),
       bad_to_the_reader_only(disturbance(R"("bursts": {"level": 1, "first_burst": "1.1 s"})")),
       good(disturbance(R"("binary_symmetric": {"flip_probability": 1})")),
       bad(disturbance(R"("binary_symmetric": {"flip_probability": 1.1})")),
       bad(disturbance(R"("binary_symmetric": {})")),
       good(disturbance(R"("gilbert_elliott": {"to_bad": 0.1, "to_good": 0.2, "bad_flip": 1})")),
       bad_to_the_reader_only(disturbance(R"("gilbert_elliott": {"to_bad": 0, "to_good": 0})")),
       bad(disturbance(R"("gilbert_elliott": {"to_bad": 0.1})")),
       good(disturbance(R"("gilbert_elliott": {"fitted_to": {"level": 4}})")),
       bad(disturbance(R"("gilbert_elliott": {"fitted_to": {"level": 4}, "to_bad": 0.1})")),
       bad_to_the_reader_only(
           disturbance(R"("gilbert_elliott": {"fitted_to": {"level": 4, "first_burst": "0 s"}})")),
       bad_to_the_reader_only(
           disturbance(R"("bursts": {"level": 1, "profile": {"name": "a", "coupling": 5}})")),
       good(disturbance(R"("flipped_bits": [{"transmission": 0, "bits": [0, 100000]}])")),
       bad(disturbance(R"("flipped_bits": [{"transmission": 0, "bits": []}])")),
       bad(disturbance(R"("flipped_bits": [{"transmission": 0, "bits": [100001]}])")),
       bad_to_the_reader_only(disturbance(R"("flipped_bits": [{"transmission": 0, "bits": [1, 1]}])"))},
      [&](const fs::path& file) {
        fault::load_plan(file, {.telegrams = &telegrams, .disturbances = emc::plan_disturbances()});
      });
}

TEST_F(Schemas, OfAPics) {
  expect_alike("cli/pics.schema.json",
               {good(R"({"items": {}})"), bad("{}"), good(R"({"items": {"outputs": true, "words": 2}})"),
                bad(R"({"items": {"ouputs": true}})"), bad(R"({"items": {"outputs": "yes"}})"),
                bad(R"({"items": {"words": -1}})"), good(R"({"items": {"words": 256}})"),
                bad(R"({"items": {"words": 257}})"), good(R"({"items": {"loss_limit": "500 ms"}})"),
                bad(R"({"items": {"loss_limit": 500}})"),
                bad_to_the_reader_only(R"({"items": {"loss_limit": "3601 s"}})"),
                good(R"({"items": {"id_code": 8191}})"), bad(R"({"items": {"id_code": 8192}})"),
                good(R"({"items": {"outputs_while_outgoing_bus_is_reset": "cleared"}})"),
                bad(R"({"items": {"outputs_while_outgoing_bus_is_reset": "clear"}})"),
                bad(R"({"items": {}, "more": 1})")},
               [](const fs::path& file) { load_pics(file, catalogue().pics_items()); });
}

TEST_F(Schemas, OfABaseline) {
  const std::string id = catalogue().entries().front().test_case->id;
  const auto with = [&](const std::string& rest) {
    return R"({"expected": [{"case": ")" + id + "\"" + rest + "}]}";
  };
  expect_alike(
      "cli/baseline.schema.json",
      {good(R"({"expected": []})"), bad("{}"), good(with(R"(, "reason": "r", "expires": "2027-03-31")")),
       good(with(R"(, "reason": "r", "expires": "2028-02-29", "finding": "late")")),
       bad(with(R"(, "expires": "2027-03-31")")), bad(with(R"(, "reason": "r")")),
       bad(with(R"(, "reason": "", "expires": "2027-03-31")")),
       bad(with(R"(, "reason": "r", "expires": "2027-13-31")")),
       bad(with(R"(, "reason": "r", "expires": "31.3.2027")")),
       bad_to_the_reader_only(with(R"(, "reason": "r", "expires": "2027-02-29")")),
       bad(with(R"(, "reason": "r", "expires": "2027-03-31", "until": 1)")),
       bad_to_the_reader_only(R"({"expected": [{"case": "a/b", "reason": "r", "expires": "2027-03-31"}]})")},
      [](const fs::path& file) {
        using namespace std::chrono;
        Baseline::load(file, catalogue(), 2026y / November / 22d);
      });
}

nlohmann::json schema_of(const char* name) {
  std::ifstream file(kSourceFolder / "cli" / name);
  return nlohmann::json::parse(file);
}

std::set<std::string> keys_of(const nlohmann::json& properties) {
  std::set<std::string> keys;
  for (const auto& [key, unused] : properties.items()) keys.insert(key);
  keys.erase("$schema");
  return keys;
}

std::string shipped(const fs::path& file) {
  std::ifstream stream(kSourceFolder / file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

TEST(PicsSchema, IsMadeOfTheRowsOfTheSuites) {
  EXPECT_EQ(shipped("cli/pics.schema.json"), pics_schema_text(catalogue()))
      << "'fieldproof schema pics' prints what the file must have";
}

TEST(NamedSchemas, AreJsonOfFilesAndOfEachRole) {
  std::set<std::string> names;
  for (const NamedText& one : named_schemas(catalogue())) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_EQ(nlohmann::json::parse(one.text)["$schema"], "http://json-schema.org/draft-07/schema#")
        << one.name;
  }
  for (const char* name :
       {"baseline", "interbus/network", "valve_bus/network", "fieldbus_dll/network", "pics", "faults",
        "fieldbus_dll/token_network", "fieldbus_dll/target_plan", "bandwidth/network", "bandwidth/plan"})
    EXPECT_TRUE(names.contains(name));
  for (const auto& suite : catalogue().suites()) {
    for (const std::string& role : suite->roles()) {
      // The cases of a whole network are nobody's settings.
      if (role == "network") continue;
      EXPECT_TRUE(names.contains(std::string(suite->protocol()) + "/" + role)) << role;
    }
  }
}

TEST(ConfigurationSchema, NamesTheOptionsThatAFileMayGive) {
  std::set<std::string> known;
  for (const Option& option : options()) {
    if (!option.is_of_the_moment && option.name != "config") known.insert(file_key(option));
  }
  EXPECT_EQ(keys_of(schema_of("configuration.schema.json")["properties"]), known);
}

std::string sequence(const std::string& role, const std::string& commands, const std::string& more = {}) {
  return R"({"schema": "fieldproof/sequence/1", "role": ")" + role +
         R"(", "seed": "1", "implementations": [{"role": "", "position": 0, "uri": "ref"}], )" + more +
         R"("commands": [)" + commands +
         R"(], "verdict": "fail", "reason": "no_answer", "fingerprint": "1f"})";
}

TEST_F(Schemas, OfASequence) {
  const std::string node = "valve_bus/node";
  const std::string wait = R"({"do": "wait", "ms": 1})";
  const std::string id = R"({"do": "inputs", "word0": 1, "word1": 2})";
  const std::string octets = R"({"do": "octets", "silence": 45, "octets": [1, 255],
                                "faults": [{"fault": "flip", "unit": 1, "level": 3}]})";
  const fs::path schema = folder_ / "sequence.schema.json";
  std::ofstream(schema) << sequence_schema_text(catalogue());
  expect_alike(
      schema,
      {good(sequence(node, wait + "," + octets)), good(sequence("interbus/slave", id)),
       bad(sequence("interbus/slave", wait)), good(sequence("valve_bus/host", wait)),
       good(sequence("interbus/master", wait)), bad(sequence("interbus/network", wait)),
       good(sequence(node, "")), bad(sequence(node, id)), bad(sequence(node, R"({"do": "wait", "ms": 0})")),
       bad(sequence(node, R"({"do": "wait", "ms": 1, "faults": []})")),
       bad(sequence(node, R"({"do": "octets", "silence": 45, "octets": [256]})")),
       bad(sequence("interbus/slave", R"({"do": "inputs", "word0": 1, "word1": 65536})")),
       good(sequence(node, wait, R"("settings": {"loss_limit": 0, "boards": 1}, )")),
       bad(sequence(node, wait, R"("settings": {"boards": 3}, )")),
       bad(sequence(node, wait, R"("settings": {"slot_time_octets": 8}, )")),
       bad_to_the_reader_only(sequence(node, wait, R"("settings": {"loss_limit": 1000000000}, )"))},
      [](const fs::path& file) { load_sequence_file(file, catalogue()); });
}

TEST_F(Schemas, OfAConfiguration) {
  expect_alike("cli/configuration.schema.json",
               {good("{}"), good(R"({"seed": 7, "jobs": 2, "strict": true, "iut": ["ref"]})"),
                good(R"({"seed": "18446744073709551615", "iut": "ref"})"), bad(R"({"sed": 7})"),
                bad(R"({"seed": 1.5})"), bad(R"({"seed": -1})"), bad(R"({"strict": 1})"),
                bad(R"({"faults": ""})"), bad(R"({"iut": [""]})"), bad(R"({"faults": ["a"]})")},
               [](const fs::path& file) {
                 Settings({"run", {}, {{"config", {file.string()}}}},
                          [](const std::string&) -> std::optional<std::string> { return std::nullopt; });
               });
}

TEST(CampaignSchema, IsMadeOfTheTableOfOptions) {
  EXPECT_EQ(shipped("cli/campaign.schema.json"), campaign_schema_text())
      << "'fieldproof schema campaign' prints what the file must have";
}

TEST_F(Schemas, OfACampaign) {
  const auto row = [](const std::string& members) {
    return R"({"jobs": [{"verb": "run", )" + members + "}]}";
  };
  const auto budget = [](const std::string& members) {
    return R"({"jobs": [{"verb": "matrix", "of": "valve_bus"}], "budget": {)" + members + "}}";
  };
  std::vector<Sample> samples = {
      bad("{}"),
      bad(R"({"jobs": []})"),
      bad(R"({"jobs": [{}]})"),
      bad(R"({"jobs": [{"verb": "list"}]})"),
      good(row(R"("of": "valve_bus/node/**", "seed": 1)")),
      good(row(R"("seed": [1, "2"], "strict": [true, false])")),
      good(row(R"("seed": {"from": 1, "count": 100}, "volume": ["quick", "full"])")),
      good(row(R"("iut": ["ref", ["node@1=ref", "node@2=mutant:check_is_sum"]])")),
      good(row(R"("of": [["valve_bus/node/read/*", "!valve_bus/node/read/is_answered"]])")),
      bad(row(R"("seed": {"from": 1})")),
      bad(row(R"("seed": {"from": 1, "count": 0})")),
      bad(row(R"("seed": [[1]])")),
      bad(row(R"("seed": -1)")),
      bad(row(R"("volume": "half")")),
      bad(row(R"("strict": "yes")")),
      bad(row(R"("max_time": "1s")")),
      bad(row(R"("out": "x")")),
      bad(row(R"("of": "--strict")")),
      bad(row(R"("iut": [])")),
      bad_to_the_reader_only(row(R"("of": "nothing/at/all")")),
      good(budget(R"("time": "1.5 h", "jobs": 1)")),
      bad_to_the_reader_only(budget(R"("time": "long")")),
      bad(budget(R"("jobs": 0)")),
      good(budget(R"("confidence": {"rate": 1e-7, "level": 0.99, "of": "data_differed"})")),
      bad(budget(R"("confidence": {"level": 0.9})")),
      bad(budget(R"("confidence": {"rate": 1})"))};
  for (const auto& file : fs::directory_iterator(kSourceFolder / "examples/campaigns"))
    samples.push_back(good(shipped("examples/campaigns" / file.path().filename())));
  expect_alike("cli/campaign.schema.json", samples,
               [](const fs::path& file) { CampaignPlan(file, catalogue()); });
}

TEST_F(Schemas, OfAMatrix) {
  conformance::Matrix matrix;
  conformance::TestCase test_case;
  test_case.id = "a/b/c";
  const conformance::Mutant mutant{"late", "M1", "b", "is late"};
  std::vector<Sample> samples;
  for (int kind = 0; kind <= static_cast<int>(conformance::CellKind::wrong_cause); ++kind) {
    conformance::RoleMatrix role{"b", {&test_case}, {&mutant}, {{}}, {{{}}}};
    role.cells[0][0].kind = static_cast<conformance::CellKind>(kind);
    matrix.roles.push_back(role);
  }
  for (int kind = 0; kind <= static_cast<int>(conformance::HoleKind::false_alarm); ++kind) {
    matrix.holes.push_back({static_cast<conformance::HoleKind>(kind), "a/b/c", "", "a sentence"});
  }
  samples.push_back(good(matrix_json(matrix)));
  nlohmann::json broken = nlohmann::json::parse(samples.front().text);
  broken["roles"][0]["cases"][0]["cells"][0]["kind"] = "seen";
  samples.push_back({broken.dump(), true, false});
  expect_alike("cli/matrix.schema.json", samples, [](const fs::path&) {});
}

}  // namespace
}  // namespace fieldproof::cli
