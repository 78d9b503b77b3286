#include "reports/history.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "harness/kernel/error.hpp"
#include "reports/embedded_schemas.hpp"
#include "reports/joined_verdict.hpp"
#include "reports/sample_page.hpp"

namespace fieldproof::reports {
namespace {

using judge::Verdict;

constexpr std::size_t kAll = 1000;

class HistoryTest : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::filesystem::path made_folder() {
    std::string name = (std::filesystem::temp_directory_path() / "fieldproof-history-XXXXXX").string();
    return ::mkdtemp(name.data());
  }

  // The n-th day; `change` makes the run another one.
  template <typename Change>
  void store(int day, Change&& change) {
    reports::Run run;
    run.identity.suite_version = "suite 1";
    run.identity.volume = "quick";
    run.identity.seed = static_cast<std::uint64_t>(day);
    run.cases = {sample_case("a", Verdict::pass), sample_case("b", Verdict::pass)};
    run.identity.selected = 2;
    Manifest manifest = sample_manifest();
    manifest.started = fmt::format("2026-01-{:02}T00:00:00Z", day);
    change(run);
    // The names are not in the order of time.
    RunDirectory::create_at(folder_ / fmt::format("{:02}", 40 - day), manifest, run.identity)
        .store(manifest, run);
  }
  void store(int day, Verdict verdict_of_b) {
    store(day, [&](reports::Run& run) { run.cases[1].verdict = verdict_of_b; });
  }

  History history(std::size_t most = kAll) const {
    const DocumentKind kinds[] = {{"fieldproof/emc/1", emc_schema},
                                  {"fieldproof/measurement/1", measurement_schema}};
    return history_of(folder_, most, kinds);
  }

  std::filesystem::path folder_ = made_folder();
};

TEST_F(HistoryTest, RunsStandInTheOrderOfTheirTime) {
  for (const int day : {3, 1, 2}) store(day, day == 2 ? Verdict::fail : Verdict::pass);
  const History found = history();
  ASSERT_EQ(found.runs.size(), 3U);
  EXPECT_EQ(found.runs[0].name, "39");
  EXPECT_EQ(found.runs[1].failed, 1U);
  EXPECT_EQ(found.runs[1].passed, 1U);
  EXPECT_EQ(found.runs[2].started, "2026-01-03T00:00:00Z");
}

TEST_F(HistoryTest, AVerdictThatComesBackIsFlakyAndOneTurnIsNot) {
  for (const int day : {1, 2}) store(day, Verdict::pass);
  store(3, Verdict::fail);
  EXPECT_TRUE(history().flaky.empty());
  store(4, Verdict::pass);
  const History found = history();
  ASSERT_EQ(found.flaky.size(), 1U);
  EXPECT_EQ(found.flaky[0].id, "b");
  EXPECT_FALSE(found.flaky[0].has_equal_seeds);
  EXPECT_EQ(found.flaky[0].verdicts[2], std::pair(std::size_t{2}, Verdict::fail));
  EXPECT_TRUE(found.broken.empty());
  EXPECT_EQ(found.flaky[0].suite_version, "suite 1");
  store(5, [](reports::Run& run) { run.identity.seed = 3; });
  EXPECT_TRUE(history().flaky[0].has_equal_seeds);
}

TEST_F(HistoryTest, OtherSuitesAndImplementationsMakeNothingFlaky) {
  store(1, Verdict::pass);
  store(2, [](reports::Run& run) {
    run.cases[1].verdict = Verdict::fail;
    run.identity.suite_version = "suite 2";
  });
  store(3, Verdict::pass);
  EXPECT_TRUE(history().flaky.empty());
  store(4, [](reports::Run& run) {
    run.cases[1].verdict = Verdict::fail;
    run.identity.implementations = {{"slave", 1, "exec:./slave"}};
  });
  const History found = history();
  EXPECT_TRUE(found.flaky.empty());
  EXPECT_TRUE(found.broken.empty()) << "another implementation never passed";
  EXPECT_EQ(found.setups.size(), 2U);
}

TEST_F(HistoryTest, WhatBeganToFailNamesTheRunSinceWhich) {
  store(1, Verdict::pass);
  store(2, Verdict::warn);
  store(3, Verdict::fail);
  store(4, Verdict::error);
  const History found = history();
  ASSERT_EQ(found.broken.size(), 1U);
  EXPECT_EQ(found.broken[0].id, "b");
  EXPECT_EQ(found.broken[0].last_good, 1U);
  EXPECT_EQ(found.broken[0].first_bad, 2U);
  EXPECT_NE(history_text(found).find("b: fails since 37, passed in 38"), std::string::npos)
      << history_text(found);
}

TEST_F(HistoryTest, ANumberThatRisesDriftsAndOneThatJumpsAboutDoesNot) {
  for (int day = 1; day <= 10; ++day) {
    store(day, [day](reports::Run& run) {
      run.cases[0].measurements = {{"rises", "us", 700.0 + day, 0, 1000},
                                   {"stays", "us", 5, 0, 10},
                                   {"jumps", "us", static_cast<double>(day * 7 % 11), 0, 20}};
    });
  }
  const History found = history();
  ASSERT_EQ(found.quantities.size(), 3U);
  EXPECT_EQ(found.varying, 2U);
  EXPECT_EQ(found.quantities[0].name, "a: rises");
  EXPECT_EQ(found.drifts(found.quantities[0]), Drifts::yes);
  EXPECT_DOUBLE_EQ(found.quantities[0].trend.slope, 1);
  EXPECT_TRUE(drift_text(found, found.quantities[0]).starts_with("drifts by +1 us from run to run (p = "));
  for (std::size_t n = 1; n < 3; ++n) EXPECT_NE(found.drifts(found.quantities[n]), Drifts::yes);
}

TEST_F(HistoryTest, DocumentsInTheFolderOfARunHaveNumbersToo) {
  for (const int day : {1, 2}) {
    store(day, Verdict::pass);
    nlohmann::ordered_json emc = sample_emc();
    emc["thresholds"]["b_from_volts"] = 48 + day;
    const std::filesystem::path run = folder_ / fmt::format("{:02}", 40 - day);
    write_text_file(run / "emc.json", emc.dump());
    write_text_file(run / "measurement.json", measurement_json(sample_measurement()));
    write_text_file(run / "broken.json", "{");
  }
  const History found = history();
  const auto b_from =
      std::ranges::find(found.quantities, "bursts, one coupler, profile A: B from", &Quantity::name);
  ASSERT_NE(b_from, found.quantities.end());
  EXPECT_EQ(b_from->unit, "V");
  EXPECT_EQ(b_from->values[1], std::pair(std::size_t{1}, 50.0));
  EXPECT_EQ(found.drifts(*b_from), Drifts::untested);
  EXPECT_TRUE(std::ranges::any_of(found.quantities, [](const Quantity& one) {
    return one.name.find(": mean ") != std::string::npos;
  })) << "of the measurement";
  EXPECT_TRUE(found.found.left_out.empty());
}

TEST_F(HistoryTest, DamagedAndForeignFoldersAreNamedAndLeftOut) {
  store(1, Verdict::pass);
  store(2, Verdict::pass);
  write_text_file(folder_ / "38" / "results.json", "{\"schema\": ");
  write_text_file(folder_ / "foreign" / "deep" / "results.json", R"({"schema": "other/1"})");
  write_text_file(folder_ / "campaign" / "manifest.json", "{}");
  write_text_file(folder_ / "campaign" / "plan.json", "{}");
  std::filesystem::create_directory_symlink("39", folder_ / "latest");
  const History found = history();
  ASSERT_EQ(found.runs.size(), 1U);
  ASSERT_EQ(found.found.left_out.size(), 2U);
  EXPECT_EQ(found.found.left_out[0].name, "38");
  EXPECT_NE(found.found.left_out[0].why.find("results.json:1"), std::string::npos)
      << found.found.left_out[0].why;
  EXPECT_EQ(found.found.left_out[1].name, "foreign/deep");
}

TEST_F(HistoryTest, NoRunAtAllIsAnError) {
  EXPECT_THROW(history(), kernel::Error);
  write_text_file(folder_ / "broken" / "results.json", "");
  try {
    history();
    FAIL() << "there is none";
  } catch (const kernel::Error& error) {
    EXPECT_NE(std::string(error.what()).find("broken cannot be read"), std::string::npos) << error.what();
  }
}

TEST_F(HistoryTest, OnlyTheLastRunsAreLookedAt) {
  for (int day = 1; day <= 5; ++day) store(day, Verdict::pass);
  const History found = history(2);
  ASSERT_EQ(found.runs.size(), 2U);
  EXPECT_EQ(found.runs[0].started, "2026-01-04T00:00:00Z");
  EXPECT_EQ(found.found.older, 3U);
}

TEST_F(HistoryTest, TheNewestRunIsTheVerdictAndAFlakyCaseIsNoPass) {
  store(1, Verdict::pass);
  store(2, Verdict::fail);
  PageContent content;
  content.history = std::make_shared<History>(history());
  EXPECT_EQ(joined_verdict(content).verdict, Verdict::fail);
  store(3, Verdict::pass);
  content.history = std::make_shared<History>(history());
  const JoinedVerdict joined = joined_verdict(content);
  EXPECT_EQ(joined.verdict, Verdict::warn);
  EXPECT_EQ(joined.sentence, "the newest run, 37: all 2 judged cases passed; 1 case is flaky");
}

}  // namespace
}  // namespace fieldproof::reports
