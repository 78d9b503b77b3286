#include "reports/schema/ajv_judge.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace fieldproof::reports {
namespace {

constexpr const char* kRangeSchema = R"({
  "$schema": "http://json-schema.org/draft-07/schema#",
  "type": "object",
  "properties": {
    "kind": {"enum": ["remote", "local"]},
    "bits": {"type": "integer", "minimum": 0, "maximum": 64},
    "place": {"$ref": "place.schema.json"}
  },
  "required": ["bits"],
  "additionalProperties": false,
  "if": {"properties": {"kind": {"const": "local"}}, "required": ["kind"]},
  "then": {"properties": {"bits": {"minimum": 4}}}
})";

class AjvJudge : public testing::Test {
 protected:
  AjvJudge()
      : folder_(std::filesystem::path(testing::TempDir()) /
                (std::string("fieldproof 'ajv' ") +
                 testing::UnitTest::GetInstance()->current_test_info()->name() + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    schema_ = write("station.schema.json", kRangeSchema);
    write("place.schema.json", R"({"$schema": "http://json-schema.org/draft-07/schema#", "type": "string"})");
  }
  ~AjvJudge() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  AjvJudgement judge(const std::vector<std::filesystem::path>& files) {
    return judge_with_ajv(FIELDPROOF_SOURCE_DIR, schema_, files);
  }

  std::filesystem::path folder_;
  std::filesystem::path schema_;
};

TEST_F(AjvJudge, AcceptsAValidFileWithComments) {
  const auto good =
      write("good.json", "\xEF\xBB\xBF// a \"station\n{\"bits\": 16, /* \" */ \"place\": \"//hall\"}");
  const AjvJudgement judgement = judge({good});
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.output, good.string() + ": valid\n");
  EXPECT_EQ(judgement.exit_code, 0);
}

TEST_F(AjvJudge, NamesEachInvalidFileWithPointerAndReason) {
  const auto good = write("good.json", R"({"bits": 3, "kind": "remote"})");
  const auto high = write("high.json", R"({"bits": 65})");
  const auto unknown = write("unknown.json", R"({"bits": 1, "bots": 1})");
  const auto local = write("local.json", R"({"bits": 3, "kind": "local"})");
  const auto place = write("place.json", R"({"bits": 3, "place": 7})");
  const auto cut = write("cut.json", R"({"bits": )");
  const AjvJudgement judgement = judge({good, high, unknown, local, place, cut});
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.exit_code, 1);
  const auto says = [&](const std::filesystem::path& file, const std::string& verdict) {
    EXPECT_NE(judgement.output.find(file.string() + ": " + verdict), std::string::npos) << judgement.output;
  };
  says(good, "valid\n");
  says(high, "invalid: /bits must be <= 64");
  says(unknown, "invalid: the top level must NOT have additional properties (\"bots\")");
  says(local, "invalid: /bits must be >= 4");
  says(place, "invalid: /place must be string");
  says(cut, "invalid: ");
}

TEST_F(AjvJudge, RefusesASchemaThatIsNone) {
  const auto good = write("good.json", "{}");
  schema_ = write("broken.schema.json", R"({"type": "nothing"})");
  const AjvJudgement judgement = judge({good});
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.exit_code, 2);
  EXPECT_NE(judgement.output.find("the schema is not usable"), std::string::npos) << judgement.output;
}

TEST_F(AjvJudge, SaysWhatToInstallWhenItIsMissing) {
  const AjvJudgement judgement = judge_with_ajv(folder_, schema_, {schema_});
  EXPECT_FALSE(judgement.is_available);
  EXPECT_NE(judgement.output.find("not installed; run"), std::string::npos);
}

}  // namespace
}  // namespace fieldproof::reports
