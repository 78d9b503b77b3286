// Subject: `fieldproof emc` as its user meets it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/probe/called_program.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

class EmcVerb : public testing::Test {
 protected:
  EmcVerb()
      : folder_(fs::path(testing::TempDir()) /
                ("fieldproof_emc_" + std::to_string(getpid()) +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
  }
  ~EmcVerb() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  Called call(std::vector<std::string> arguments) const {
    Call made;
    made.program = FIELDPROOF_EXE;
    made.arguments = std::move(arguments);
    made.arguments.insert(made.arguments.begin(), {"emc", "interbus", "--quiet"});
    if (std::ranges::count(made.arguments, "--duration") == 0) {
      made.arguments.insert(made.arguments.end(), {"--duration", "1s"});
    }
    made.folder = folder_;
    return made.run();
  }

  std::string text_of(const std::string& file) const {
    std::ifstream input(folder_ / file);
    return {std::istreambuf_iterator<char>(input), {}};
  }

  fs::path folder_;
};

TEST_F(EmcVerb, TellsEachTestAndTheLedger) {
  const Called called = call({"--levels", "1,x:1000..2000:500", "--json", "emc.json"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_NE(called.out.find("X (1500 V)"), std::string::npos) << called.out;
  EXPECT_NE(called.out.find("not calibrated"), std::string::npos) << called.out;
  const nlohmann::json document = nlohmann::json::parse(text_of("emc.json"));
  ASSERT_EQ(document.at("tests").size(), 16U);
  for (const auto& test : document.at("tests")) {
    EXPECT_GT(test.at("ledger").at("sent"), 1000);
    EXPECT_EQ(test.at("ledger").at("accepted_wrong_inputs"), 0);
  }
  EXPECT_EQ(document.at("total").at("accepted_wrong"), 0);
  const auto& residual = document.at("residual");
  EXPECT_EQ(residual.at("frame_check"), "CRC-16/IBM-3740");
  EXPECT_DOUBLE_EQ(residual.at("expected_wrong_at_most").get<double>(),
                   residual.at("worst_share_of_corrupted").get<double>() *
                       document.at("total").at("corrupted").get<double>());
}

TEST_F(EmcVerb, TheNumberOfThreadsChangesNothing) {
  EXPECT_EQ(call({"--jobs", "1", "--levels", "1..4", "--json", "one.json"}).exit_code, 0);
  EXPECT_EQ(call({"--jobs", "2", "--levels", "1..4", "--json", "two.json"}).exit_code, 0);
  EXPECT_EQ(text_of("one.json"), text_of("two.json"));
  EXPECT_FALSE(text_of("one.json").empty());
}

TEST_F(EmcVerb, EndsWithOneWhereTheCriterionIsWorseThanAllowed) {
  EXPECT_EQ(call({"--levels", "3", "--worst", "A"}).exit_code, 1);
  EXPECT_EQ(call({"--levels", "3", "--worst", "A", "--profile", "C"}).exit_code, 0);
  const Called caught =
      call({"--levels", "3", "--iut", "slave@1=deviant:does_not_mark_status", "--duration", "5s"});
  EXPECT_EQ(caught.exit_code, 1);
  EXPECT_NE(caught.out.find("reproduce: fieldproof emc interbus"), std::string::npos) << caught.out;
}

TEST_F(EmcVerb, RefusesWhatItCannotServe) {
  const auto refusal = [&](std::vector<std::string> arguments) {
    const Called called = call(std::move(arguments));
    EXPECT_EQ(called.exit_code, 64) << called.err;
    return called.err;
  };
  for (const char* level : {"5", "0", "x:", "x:0", "x:1000..500", "1..2..3", "one", "1.5", "x:nan"}) {
    EXPECT_NE(refusal({"--levels", level}).find("level"), std::string::npos) << level;
  }
  EXPECT_NE(refusal({"--repetition", "7kHz"}).find("2.5kHz"), std::string::npos);
  EXPECT_NE(refusal({"--polarity", "x"}).find("+, -"), std::string::npos);
  EXPECT_NE(refusal({"--profile", "F"}).find("profile"), std::string::npos);
  EXPECT_NE(refusal({"--iut", "slave@9=deviant:does_not_mark_status"}).find("1 to 3"), std::string::npos);
  EXPECT_NE(refusal({"--duration", "2h"}).find("1 h"), std::string::npos);
}

TEST_F(EmcVerb, JsonIsValidForItsSchema) {
  ASSERT_EQ(call({"--levels", "1", "--json", "emc.json"}).exit_code, 0);
  const fs::path source = FIELDPROOF_SOURCE_DIR;
  const auto judgement =
      reports::judge_with_ajv(source, source / "reports/schema/emc.schema.json", {folder_ / "emc.json"});
  if (!judgement.is_available) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.exit_code, 0) << judgement.output;
}

}  // namespace
}  // namespace fieldproof::cli
