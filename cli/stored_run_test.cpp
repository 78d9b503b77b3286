// Subject: the program as its user meets it. What a run leaves behind: replayed, judged again, compared.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli/probe/probe_fixture.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

using Stored = Program;

TEST_F(Stored, ResultsAreTheSameBytesForAnyNumberOfJobs) {
  const std::vector<std::string> all = {"run", "probe/**", "odd/slow/**", "+odd", "!odd/end/never_repeats"};
  std::vector<std::string> outputs;
  for (const char* jobs : {"1", "2", "4"}) {
    std::vector<std::string> arguments = all;
    arguments.insert(arguments.end(), {"--jobs", jobs, "--out", std::string("jobs") + jobs});
    outputs.push_back(probe(arguments).out);
  }
  EXPECT_EQ(outputs[0], outputs[1]);
  EXPECT_EQ(outputs[0], outputs[2]);
  EXPECT_FALSE(read("jobs1/results.json").empty());
  EXPECT_EQ(read("jobs1/results.json"), read("jobs2/results.json"));
  EXPECT_EQ(read("jobs1/results.json"), read("jobs4/results.json"));
}

TEST_F(Stored, RunsLieBelowRunsWithALinkToTheLatest) {
  EXPECT_EQ(code({"run", "probe/**"}), 0);
  for (const char* file :
       {"manifest.json", "results.json", "junit.xml", "journal.jsonl", "configuration.json"}) {
    EXPECT_TRUE(fs::exists(folder_ / "runs/latest" / file)) << file;
  }
  EXPECT_EQ(code({"run", "probe/**", "--out", "runs/latest"}), 65);
}

TEST_F(Stored, FailingCaseReplaysBitForBit) {
  EXPECT_EQ(code({"run", "probe/station/data/word_is_held", "--iut", "mutant:swapped", "--out", "a"}), 1);
  const fs::path file = case_file("a");
  const Called called = probe({"replay", file.string(), "--bits"});
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_HOLDS(called.out, "equal: verdict, reason and fingerprint are those of the stored run");
  EXPECT_HOLDS(called.out, read(fs::relative(file.parent_path() / "trace.txt", folder_)));
  EXPECT_EQ(code({"replay", file.string(), "--iut", "ref"}), 0);
  EXPECT_EQ(code({"replay", file.string(), "--pcapng", "one", "--vcd", "./one"}), 64);
  const Called verified = probe({"verify", file.string()});
  EXPECT_EQ(verified.exit_code, 1) << verified.err;
  EXPECT_HOLDS(verified.out, "1 of 1 cases are equal in 2 runs, and 1 of them fails each time");
}

TEST_F(Stored, ReplayTellsWhatDiffers) {
  EXPECT_EQ(code({"run", "probe/station/data/word_is_held", "--iut", "mutant:swapped", "--out", "a"}), 1);
  const fs::path file = fs::relative(case_file("a"), folder_);
  std::string text = read(file);
  text.replace(text.find("wrong_word"), 10, "other_word");
  write(file, text);
  const Called called = probe({"replay", file.string()});
  EXPECT_EQ(called.exit_code, 3);
  EXPECT_HOLDS(called.out, "differs: reason was 'other_word', is 'wrong_word'");
  text.replace(text.find("\"case_seed\": \""), 14, "\"case_seed\": \"1");
  write(file, text);
  const Called bad = probe({"replay", file.string()});
  EXPECT_EQ(bad.exit_code, 65);
  EXPECT_HOLDS(bad.err, "case.json:5: /case_seed: ");
}

TEST_F(Stored, PlanAndPicsTravelWithTheCase) {
  write("plan.json", "{\"rules\": [{\"effect\": {\"drop\": {}}}]}");
  write("pics.json", "{\"items\": {\"x\": true, \"n\": 4, \"s\": \"zero\"}}");
  const char* failing = "probe/station/time/answer_is_in_time";
  EXPECT_EQ(code({"run", failing, "--iut", "mutant:late", "--faults", "plan.json", "--pics", "pics.json",
                  "--out", "a"}),
            1);
  fs::remove(folder_ / "plan.json");
  fs::remove(folder_ / "pics.json");
  fs::rename(folder_ / "a", folder_ / "moved");
  EXPECT_EQ(code({"replay", case_file("moved").string()}), 1);
  EXPECT_EQ(read("moved/plan.json"), "{\"rules\": [{\"effect\": {\"drop\": {}}}]}");
}

TEST_F(Stored, RunIsJudgedAgainFromItsRecordings) {
  EXPECT_EQ(code({"run", "probe/**", "--iut", "mutant:swapped", "--record", "all", "--out", "a"}), 1);
  const Called called = probe({"judge", "a"});
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_HOLDS(called.out, "4 of 4 cases were judged again, 0 of them otherwise than before");
  EXPECT_EQ(code({"run", "probe/**", "--out", "b"}), 0);
  EXPECT_EQ(code({"judge", "b"}), 4);
}

TEST_F(Stored, DifferenceNamesNewFailuresAndFixedOnes) {
  probe({"run", "probe/**", "--iut", "mutant:swapped", "--out", "a"});
  probe({"run", "probe/**", "--iut", "mutant:late", "--out", "b"});
  const Called called = probe({"diff", "a", "b", "--json", "diff.json"});
  EXPECT_EQ(called.exit_code, 1);
  EXPECT_HOLDS(called.out, "new failures (1)");
  EXPECT_HOLDS(called.out, "fixed (3)");
  EXPECT_HOLDS(read("diff.json"), "answer_is_in_time");
  EXPECT_EQ(code({"diff", "a", "a"}), 0);
}

// Cases that nobody judges any more are no result that is as good as before.
TEST_F(Stored, CasesThatDisappearedLeaveADifferenceOpen) {
  ASSERT_EQ(code({"run", "probe/**", "--out", "a"}), 0);
  ASSERT_EQ(code({"run", "probe/station/data/word_is_latched", "--out", "b"}), 0);
  const Called called = probe({"diff", "a", "b"});
  EXPECT_EQ(called.exit_code, 2) << called.out;
  EXPECT_HOLDS(called.out, "disappeared (");
  EXPECT_EQ(code({"diff", "b", "a"}), 0);
}

TEST_F(Stored, FailedIsNarrowedBySelectorsAndBySettings) {
  probe({"run", "probe/**", "--iut", "mutant:swapped", "--seed", "9"});
  const Called narrowed = probe({"run", "--failed", "probe/station/data/word_is_h*"});
  EXPECT_EQ(narrowed.exit_code, 1) << narrowed.err;
  EXPECT_HOLDS(narrowed.out, "1 of 1 selected cases judged");
  EXPECT_HOLDS(narrowed.out, "seed 9,");
  const Called nowhere = probe({"run", "--failed", "runs/nowhere"});
  EXPECT_EQ(nowhere.exit_code, 64);
  EXPECT_HOLDS(nowhere.err, "'runs/nowhere' is no folder");
  EXPECT_EQ(code({"run", "--failed", "--iut", "ref"}), 0);
  EXPECT_EQ(code({"run", "--failed", "runs/nowhere"}), 64) << "also where nothing has failed";
  EXPECT_EQ(code({"run", "--failed"}), 4);
}

TEST_F(Stored, FailFastEndsAfterTheFirstFailure) {
  const Called called = probe({"run", "probe/**", "--iut", "mutant:swapped", "--fail-fast", "--jobs", "3"});
  EXPECT_EQ(called.exit_code, 1);
  EXPECT_HOLDS(called.out, "1 of 4 selected cases judged: 0 pass, 1 fail; 3 not run");
}

TEST_F(Stored, CopiesThatCannotBeWrittenAreRefusedBeforeTheRun) {
  write("file", "");
  for (const char* option : {"--junit", "--json"}) {
    const Called called = probe({"run", "probe/**", option, "file/x.xml"});
    EXPECT_EQ(called.exit_code, 74);
    EXPECT_FALSE(fs::exists(folder_ / "runs"));
  }
  EXPECT_EQ(code({"matrix", "probe", "--json", "file/x.json"}), 74);
}

TEST_F(Stored, LatestThatIsNoLinkIsToldAndLeavesNothing) {
  fs::create_directories(folder_ / "runs/latest/mine");
  const Called called = probe({"run", "probe/**"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_HOLDS(called.err, "runs/latest does not lead to this run");
  for (const auto& entry : fs::directory_iterator(folder_ / "runs")) {
    EXPECT_NE(entry.path().filename().string().rfind(".latest", 0), 0U) << entry.path();
  }
}

TEST_F(Stored, DocumentsThatAreNoRunAreRefusedAtTheirPlace) {
  EXPECT_EQ(code({"run", "probe/**", "--out", "a"}), 0);
  const std::string good = read("a/results.json");
  const auto refused = [&](const std::string& text) {
    write("a/results.json", text);
    const Called called = probe({"diff", "a", "a"});
    EXPECT_EQ(called.exit_code, 65) << called.err;
    EXPECT_HOLDS(called.err, "a/results.json:");
  };
  refused("{\"schema\": \"fieldproof/results/1\", \"cases\": " + std::string(1'000'000, '['));
  std::string text = good;
  refused(text.replace(text.find("\"selected\": 4"), 13, "\"selected\": -1"));
  text = good;
  refused(text.replace(text.find("\"exit_code\": 0"), 14, "\"exit_code\": 1e300"));
}

}  // namespace
}  // namespace fieldproof::cli
