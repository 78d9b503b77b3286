// Subject: the page of a report, driven in a browser by page/browser_test.mjs.
#include <gtest/gtest.h>

#include "reports/approved_text.hpp"
#include "reports/sample_history.hpp"
#include "reports/sample_page.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::reports {
namespace {

constexpr int kNoBrowser = 77;

AjvJudgement drive(const std::filesystem::path& page, const std::string& environment = "") {
  const std::string driver = std::string(FIELDPROOF_SOURCE_DIR) + "/reports/page/browser_test.mjs";
  return run_for_judgement(environment + "node " + shell_word(driver) + " " + shell_word(page.string()) +
                           " 2>&1");
}

TEST(BrowserSerialRuns, APageWithEverythingServesItsReader) {
  if (run_for_judgement("node --version 2>/dev/null").exit_code != 0) {
    GTEST_SKIP() << "the page is driven by node, which is not installed; run script/setup";
  }
  const TemporaryFolder folder;
  write_text_file(folder.path() / "report.html", html_page(sample_page()));
  const AjvJudgement judgement = drive(folder.path() / "report.html");
  if (judgement.exit_code == kNoBrowser) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.exit_code, 0) << judgement.output;
}

TEST(BrowserSerialRuns, TwoRunsSideBySideAndAHistoryServeTheirReader) {
  if (run_for_judgement("node --version 2>/dev/null").exit_code != 0) {
    GTEST_SKIP() << "the page is driven by node, which is not installed; run script/setup";
  }
  PageContent content;
  content.runs = {sample_page_run(), sample_page_run()};
  content.runs[0].name = kHostileName;
  for (judge::CaseResult& result : content.runs[0].stored.run.cases) {
    if (result.id.ends_with("case_3") || result.id.ends_with("case_4")) result.verdict = judge::Verdict::pass;
  }
  content.is_comparison = true;
  content.history = sample_history(kHostileName);
  const TemporaryFolder folder;
  write_text_file(folder.path() / "report.html", html_page(content));
  const AjvJudgement judgement = drive(folder.path() / "report.html", "FIELDPROOF_ANY_LOAD_TIME=1 ");
  if (judgement.exit_code == kNoBrowser) GTEST_SKIP() << judgement.output;
  EXPECT_EQ(judgement.exit_code, 0) << judgement.output;
}

}  // namespace
}  // namespace fieldproof::reports
