#include "reports/github_writer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <sstream>

#include "harness/judge/arbitrary_result.hpp"
#include "harness/kernel/arbitrary_text.hpp"
#include "reports/approved_text.hpp"
#include "reports/sample_run.hpp"

namespace fieldproof::reports {
namespace {

std::vector<std::string> lines_in(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

reports::Run failing_cases(std::size_t count) {
  Run run;
  for (std::size_t n = 0; n < count; ++n) {
    run.cases.push_back(sample_case("a/b/case_" + std::to_string(n),
                                    n == 20 ? judge::Verdict::error : judge::Verdict::fail, "late"));
  }
  return run;
}

TEST(GithubAnnotations, AndTheSummaryAreTheApprovedTexts) {
  expect_approved("github.txt", github_annotations(sample_run(), {}) + github_summary(sample_run(), {}));
}

// GitHub shows ten.
TEST(GithubAnnotations, AreTheWorstNineAndHowManyMore) {
  const std::vector<std::string> lines = lines_in(github_annotations(failing_cases(30), {}));
  ASSERT_EQ(lines.size(), 10U);
  EXPECT_EQ(lines[0].find("::error title=a/b/case_20::error%"), std::string::npos);
  EXPECT_TRUE(lines[0].starts_with("::error title=a/b/case_20::error: late%0A")) << lines[0];
  EXPECT_TRUE(lines[1].starts_with("::error title=a/b/case_0::")) << lines[1];
  EXPECT_NE(lines[9].find("21 more cases"), std::string::npos);
  EXPECT_EQ(lines_in(github_annotations(failing_cases(9), {})).size(), 9U);
  EXPECT_TRUE(github_annotations(reports::Run{}, {}).empty());
}

TEST(GithubAnnotations, EscapeWhatCommandsReserve) {
  reports::Run run = failing_cases(1);
  run.cases[0].id = "a/b,c:d%e";
  run.cases[0].reason = "50 %\r\n::set-env name=X::y";
  const std::string text = github_annotations(run, {});
  EXPECT_TRUE(text.starts_with("::error title=a/b%2Cc%3Ad%25e::fail: 50 %25")) << text;
  EXPECT_EQ(std::ranges::count(text, '\n'), 1);
}

TEST(GithubAnnotations, TellThatTheRunIsIncomplete) {
  EXPECT_TRUE(github_annotations(sample_run(), {}).starts_with("::error title=is_complete::"));
}

RC_GTEST_PROP(GithubAnnotations, AreAtMostTenLinesEachOneCommandForAnyText, ()) {
  reports::Run run = sample_run();
  run.identity.reproduce_options = *kernel::arbitrary_text();
  run.cases =
      *rc::gen::scale(0.3, rc::gen::container<std::vector<judge::CaseResult>>(judge::arbitrary_result()));
  const std::vector<std::string> lines = lines_in(github_annotations(run, {}));
  RC_ASSERT(lines.size() <= 10U);
  for (const std::string& line : lines) RC_ASSERT(line.starts_with("::error title="));
}

TEST(GithubSummary, HasNoMarkupOfAnyText) {
  reports::Run run = failing_cases(1);
  run.cases[0].reason = "| <img src=x> [a](http://b) `c` **d**\n# e";
  const std::string text = github_summary(run, {});
  for (const char* markup : {"<img", "](", "`c`", "**d**", "\n# e", "http://"}) {
    EXPECT_EQ(text.find(markup), std::string::npos) << markup;
  }
  EXPECT_NE(text.find("1 of 1 selected cases judged"), std::string::npos);
}

// GitHub takes 1 MiB of a step, and nothing of what is larger.
TEST(GithubSummary, StaysWithinWhatAStepMayHave) {
  reports::Run run = failing_cases(2000);
  for (judge::CaseResult& result : run.cases) result.reason = std::string(5000, '*');
  const std::string text = github_summary(run, {});
  EXPECT_LT(text.size(), 1U << 20U);
  EXPECT_NE(text.find(" more did not pass"), std::string::npos);
}

RC_GTEST_PROP(GithubLog, HasNoCommand, ()) {
  std::string text = *kernel::arbitrary_text() + "\n   ::error::x\n a ##[debug]y\n::stop-commands::z";
  for (const std::string& line : lines_in(github_log(text))) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    RC_ASSERT(!line.substr(begin).starts_with("::"));
    RC_ASSERT(line.find("##[") == std::string::npos);
  }
}

TEST(GithubLog, LeavesEverythingElse) {
  const std::string text = "pass   a::b\n\n  actual  x\nno end";
  EXPECT_EQ(github_log(text), text);
}

}  // namespace
}  // namespace fieldproof::reports
