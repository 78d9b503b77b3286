#include "reports/text_summary.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "harness/judge/arbitrary_result.hpp"
#include "harness/kernel/arbitrary_text.hpp"
#include "reports/approved_text.hpp"
#include "reports/sample_run.hpp"

namespace fieldproof::reports {
namespace {

TEST(TextSummary, WritesTheApprovedTexts) {
  const reports::Run run = sample_run();
  expect_approved("summary.txt", run_header(run.identity, sample_manifest()) + summary_text(run));
  expect_approved("finding.txt", finding_text(run.identity, sample_failure()));
}

TEST(TextSummary, EndsAFailureWithTheCommandThatReproducesTheHeaviestCase) {
  const std::string text = summary_text(sample_run());
  EXPECT_TRUE(
      text.ends_with("reproduce: fieldproof run interbus/master/stop/bus_is_left --seed 7 --iut "
                     "slave@3=mutant:accepts_bad_check\n"));
}

TEST(TextSummary, SaysNothingMoreWhenAllPass) {
  reports::Run run;
  run.cases = {sample_case("a/b", judge::Verdict::pass)};
  EXPECT_EQ(summary_text(run), "pass: 1 of 1 selected cases judged: 1 pass, 0 fail\n");
}

TEST(TextSummary, ShowsAtMostTheFindingsAskedFor) {
  reports::Run run;
  for (const char* id : {"a/1", "a/2", "a/3"})
    run.cases.push_back(sample_case(id, judge::Verdict::fail, "r"));
  const std::string text = summary_text(run, {false, 1});
  EXPECT_NE(text.find("2 more cases with findings are in results.json"), std::string::npos);
  EXPECT_EQ(text.find("a/2"), std::string::npos);
}

TEST(TextSummary, PaintsOnlyWhenAsked) {
  EXPECT_EQ(case_line(sample_case("a/b", judge::Verdict::pass)), "pass           a/b\n");
  EXPECT_EQ(case_line(sample_case("a/b", judge::Verdict::fail, "r"), {true, 1}),
            "\x1b[31mfail          \x1b[0m a/b  (r)\n");
}

TEST(TextSummary, TellsTheCaveatsBehindTheCounts) {
  reports::Run run = sample_run();
  run.identity.caveats = {"A model.", "Another one."};
  const std::string text = summary_text(run, {false, 0});
  EXPECT_NE(text.find("\nunverified: A model.\nunverified: Another one.\nreproduce: "), std::string::npos)
      << text;
}

TEST(TextSummary, TellsWhatThePlanOfFaultsDidAndFirstWhatNeverHit) {
  reports::Run run = sample_run();
  run.identity.plan = {{"/rules/0", ""}, {"/rules/1", "a slip"}, {"/disturbances/0", "welder"}};
  run.cases.at(0).planned_hits = {2, 0, 0};
  run.cases.at(1).planned_hits = {3, 0, 7};
  const std::string text = summary_text(run, {false, 0});
  EXPECT_NE(text.find("\nplan /rules/1 (a slip): never hit in 2 cases\n"
                      "plan /rules/0: hit 5 times, in 2 of 2 cases\n"
                      "plan /disturbances/0 (welder): hit 7 times, in 1 of 2 cases\n"),
            std::string::npos)
      << text;
}

TEST(TextSummary, EndsALongPlan) {
  reports::Run run = sample_run();
  run.identity.plan.assign(10'000, {"/rules/0", "a"});
  run.cases.at(0).planned_hits.assign(10'000, 1);
  const std::string text = summary_text(run, {false, 0});
  EXPECT_LT(std::ranges::count(text, '\n'), 40);
  EXPECT_NE(text.find("plan: 9980 more parts are in results.json\n"), std::string::npos);
}

TEST(TextSummary, EscapesWhatChangesATerminal) {
  EXPECT_EQ(escaped_line("\x1b[2J\r\n\t\x7f"), "\\x1B[2J\\x0D\\x0A\\x09\\x7F");
  EXPECT_EQ(escaped_line("\xc2\x9b\xe2\x80\xae\xef\xbb\xbf"), "\\u{009B}\\u{202E}\\u{FEFF}");
  EXPECT_EQ(escaped_line("\x9b\xff"), "\\x9B\\xFF");
  EXPECT_EQ(escaped_line("gr\xc3\xbc\xc3\x9f"), "gr\xc3\xbc\xc3\x9f");
  EXPECT_EQ(escaped_block("a\n\tb\r"), "a\n\tb\\x0D");
}

RC_GTEST_PROP(TextSummary, LetsNoControlCharacterPass, ()) {
  reports::Run run = sample_run();
  run.cases.push_back(*judge::arbitrary_result());
  run.cases.back().verdict = judge::Verdict::fail;
  run.identity.incomplete_because = *kernel::arbitrary_text();
  run.identity.reproduce_options = *kernel::arbitrary_text();
  run.identity.caveats = {*kernel::arbitrary_text()};
  run.identity.plan = {{*kernel::arbitrary_text(), *kernel::arbitrary_text()}};
  const std::string text = summary_text(run, {false, 100});
  RC_ASSERT(std::none_of(text.begin(), text.end(),
                         [](char c) { return (c >= 0 && c < 0x20 && c != '\n' && c != '\t') || c == 0x7F; }));
  RC_ASSERT(text.find("\xc2\x9b") == std::string::npos);
  RC_ASSERT(text.find("\xe2\x80\xae") == std::string::npos);
  RC_ASSERT(text.back() == '\n');
}

}  // namespace
}  // namespace fieldproof::reports
