// Subject: a run that was cut by --shard, joined again by report.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "cli/probe/probe_fixture.hpp"

namespace fieldproof::cli {
namespace {

class JoinedShards : public Program {
 protected:
  Called run(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {
        "run",   "probe/**",       "odd/slow/**", "odd/end/*", "!odd/end/breaks", "!odd/end/never_repeats",
        "--iut", "mutant:swapped", "--out",       out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return probe(arguments);
  }
  void run_parts() const {
    for (const char* part : {"1", "2", "3"}) run(part, {"--shard", std::string(part) + "/3"});
  }
  void expect_refusal(const std::vector<std::string>& directories, const std::string& told) const {
    std::vector<std::string> arguments = {"report", "--json", "joined.json"};
    arguments.insert(arguments.end(), directories.begin(), directories.end());
    const Called called = probe(arguments);
    EXPECT_EQ(called.exit_code, 65) << called.err;
    EXPECT_HOLDS(called.err, told);
    EXPECT_TRUE(read("joined.json").empty());
  }

  // Without what the occasion decides.
  static std::string timeless(const std::string& text) {
    static const std::regex kTimes(R"re(( time(stamp)?="[^"]*")|("wall_time" value="[^"]*"))re");
    return std::regex_replace(text, kTimes, "");
  }
};

TEST_F(JoinedShards, AreTheRunThatWasNeverCut) {
  EXPECT_EQ(run("whole", {"--json", "whole.json", "--junit", "whole.xml"}).exit_code, 1);
  run_parts();
  const Called made = probe({"report", "3", "1", "2", "--json", "joined.json", "--junit", "joined.xml"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_FALSE(read("whole.json").empty());
  EXPECT_EQ(read("joined.json"), read("whole.json"));
  EXPECT_EQ(timeless(read("joined.xml")), timeless(read("whole.xml")));
  // The page is of the same run then.
  EXPECT_EQ(probe({"report", "1", "2", "3", "--html", "page.html", "--json", "joined.json"}).exit_code, 0);
  const std::string page = read("page.html");
  EXPECT_HOLDS(page, "\"1, 2, 3\"");
}

TEST_F(JoinedShards, KeepTheRulesAndTheBaselineThatTheyRanUnder) {
  write("known.json", R"({ "expected": [
    { "case": "odd/end/warns", "reason": "so it is", "expires": "2001-01-01" },
    { "case": "odd/end/fails", "reason": "known", "expires": "2999-01-01" },
    { "case": "odd/slow/case_00", "reason": "was slow", "expires": "2999-01-01" } ] })");
  const std::vector<std::string> strict = {"--strict", "--baseline", "known.json"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), strict.begin(), strict.end());
    return more;
  };
  const Called whole = run("whole", with({"--json", "whole.json", "--junit", "whole.xml"}));
  ASSERT_LT(whole.exit_code, 5) << whole.err;
  for (const char* part : {"1", "2"}) run(part, with({"--shard", std::string(part) + "/2"}));
  ASSERT_EQ(probe({"report", "1", "2", "--json", "joined.json", "--junit", "joined.xml"}).exit_code, 0);
  EXPECT_EQ(read("joined.json"), read("whole.json"));
  EXPECT_EQ(timeless(read("joined.xml")), timeless(read("whole.xml")));
}

TEST_F(JoinedShards, AreRefusedWhereTheyAreNoWhole) {
  run_parts();
  run("whole");
  run("other", {"--shard", "3/3", "--seed", "2"});
  run("strict", {"--shard", "3/3", "--strict"});
  run("half", {"--shard", "1/2"});
  probe({"run", "probe/**", "--iut", "mutant:swapped", "--shard", "3/3", "--out", "fewer"});
  run("reference", {"--shard", "3/3", "--iut", "ref"});
  expect_refusal({"1", "3"}, "part 2/3 is missing");
  expect_refusal({"1"}, "part 2/3 is missing");
  expect_refusal({"1", "2", "2"}, "2: this is part 2/3, and so is 2");
  expect_refusal({"1", "2", "other"}, "other: this is no part of the same run as 1: the seed was 2, not 1");
  expect_refusal({"1", "2", "strict"}, "--strict");
  expect_refusal({"1", "2", "fewer"}, "selectors");
  expect_refusal({"2", "half"}, "half: this is part 1/2");
  expect_refusal({"whole", "1"}, "whole: this run is no part");
  expect_refusal({"1", "2", "none"}, "none");
  // What a run was configured with is a file that anybody may have written.
  for (const char* shard : {"a/3", "", "/", "0/0", "3/3/3", "99999999999/3"}) {
    write("3/configuration.json", std::string(R"({"shard": ")") + shard + R"("})");
    expect_refusal({"1", "2", "3"}, ": ");
  }
}

TEST_F(JoinedShards, OnePartIsNoPassOnAPage) {
  probe({"run", "probe/**", "--shard", "1/2", "--out", "half"});
  const Called page = probe({"report", "half", "--html", "half.html"});
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_TRUE(page.out.starts_with("inconclusive: ")) << page.out;
}

// More parts than cases: some have none.
// Without the file that says so nobody can tell a part from a whole run.
TEST_F(JoinedShards, APartWithoutItsConfigurationIsNoWholeRun) {
  run("1", {"--shard", "1/2"});
  run("2", {"--shard", "2/2"});
  for (const char* part : {"1", "2"}) std::filesystem::remove(folder_ / part / "configuration.json");
  expect_refusal({"1", "2"},
                 "1: configuration.json is missing in it, so nobody knows which part of a run it is");
  const Called page = probe({"report", "1", "--html", "page.html"});
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_HOLDS(page.out, "the run is incomplete: its configuration.json is missing");
  const Called alone = probe({"report", "1", "--json", "alone.json"});
  EXPECT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_EQ(json("alone.json")["run"]["complete"], false);
  EXPECT_HOLDS(json("alone.json")["run"]["incomplete_because"].get<std::string>(),
               "configuration.json is missing");
}

TEST_F(JoinedShards, APartWithoutCasesIsJoined) {
  std::vector<std::string> report{"report"};
  for (const char* part : {"1", "2", "3", "4", "5", "6", "7"}) {
    const std::string shard = std::string(part) + "/7";
    probe({"run", "probe/**", "--iut", "ref", "--shard", shard, "--out", part});
    report.emplace_back(part);
  }
  report.insert(report.end(), {"--json", "whole.json"});
  EXPECT_EQ(probe(report).exit_code, 0) << probe(report).err;
}

// Selectors may stand in a file, which may have changed since.
TEST_F(JoinedShards, OfOtherCasesThanNowAreRefused) {
  write("some.txt", "probe/**\n");
  for (const char* part : {"1", "2"})
    probe({"run", "@some.txt", "--shard", std::string(part) + "/2", "--out", part});
  ASSERT_EQ(probe({"report", "1", "2", "--junit", "joined.xml"}).exit_code, 0);
  write("some.txt", "probe/**\nodd/slow/**\n");
  expect_refusal({"1", "2"}, "its selectors select");
}

TEST_F(JoinedShards, OfWhichOneDidNotEndHaveNotEnded) {
  for (const char* part : {"1", "2"})
    run(part, {"--shard", std::string(part) + "/2", "--fail-fast", "--jobs", "1"});
  ASSERT_EQ(probe({"report", "1", "2", "--json", "joined.json", "--junit", "joined.xml"}).exit_code, 0);
  EXPECT_EQ(json("joined.json")["run"]["complete"], false);
  EXPECT_GT(json("joined.json")["counts"]["not_run"], 0);
  EXPECT_HOLDS(read("joined.xml"), "is_complete");
}

}  // namespace
}  // namespace fieldproof::cli
