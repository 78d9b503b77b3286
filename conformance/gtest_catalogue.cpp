#include "conformance/gtest_catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "conformance/runner.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

using judge::Verdict;

class RegisteredCase : public testing::Test {
 public:
  RegisteredCase(const Suite& suite, const TestCase& test_case, std::shared_ptr<const SetupFactory> setup_for)
      : suite_(suite), test_case_(test_case), setup_for_(std::move(setup_for)) {}

  void TestBody() override {
    try {
      judge_case();
    } catch (const kernel::Error& error) {
      FAIL() << error.what();
    }
  }

 private:
  void judge_case() {
    const CaseRun done = run_case({&suite_, &test_case_}, (*setup_for_)(test_case_));
    const judge::CaseResult& result = done.outcome.result;
    RecordProperty("verdict", std::string(judge::name(result.verdict)));
    RecordProperty("seed", std::to_string(result.seed));
    RecordProperty("fingerprint", fmt::format("{:016x}", result.fingerprint));
    if (result.verdict == Verdict::not_applicable) GTEST_SKIP() << "not applicable: " << result.reason;
    if (result.verdict == Verdict::pass || result.verdict == Verdict::warn) return;
    FAIL() << failure_message(test_case_, result);
  }

  const Suite& suite_;
  const TestCase& test_case_;
  std::shared_ptr<const SetupFactory> setup_for_;
};

std::string told(const judge::Finding& finding) {
  std::string text = fmt::format("{}: {} at {}\n", judge::name(finding.verdict), finding.reason,
                                 kernel::describe(finding.time));
  const auto line = [&text](std::string_view label, const std::string& value) {
    if (!value.empty()) text += fmt::format("  {:<12}{}\n", label, value);
  };
  line("requirement", finding.requirement);
  line("source", fmt::format("{}{}{}{}", finding.reference.source,
                             finding.reference.clause.empty() ? "" : ", ", finding.reference.clause,
                             judge::is_verified(finding.reference.standing) ? "" : " (unverified)"));
  line("expected", fmt::format("{}", fmt::join(finding.expected, " | ")));
  line("actual", finding.actual);
  line("in step", finding.step);
  line("differs at", finding.first_difference);
  for (const std::string& decides : finding.decisive) line("decisive", decides);
  for (const std::string& decoded : finding.decode) text += fmt::format("    {}\n", decoded);
  return text;
}

}  // namespace

GoogleTestName googletest_name(const std::string& case_id) {
  const std::size_t last = case_id.rfind('/');
  if (last == std::string::npos) return {"conformance", case_id};
  GoogleTestName name{case_id.substr(0, last), case_id.substr(last + 1)};
  std::replace(name.suite.begin(), name.suite.end(), '/', '.');
  return name;
}

std::string failure_message(const TestCase& test_case, const judge::CaseResult& result) {
  std::string text = fmt::format("{} ({}): {}, seed of the case {}\n", test_case.id, test_case.purpose,
                                 judge::name(result.verdict), result.seed);
  if (result.findings.empty() && !result.reason.empty()) text += fmt::format("  {}\n", result.reason);
  for (const judge::Finding& finding : result.findings) text += told(finding);
  return text;
}

std::size_t register_with_googletest(const Suite& suite, SetupFactory setup_for) {
  const auto shared = std::make_shared<const SetupFactory>(std::move(setup_for));
  std::size_t registered = 0;
  for (const TestCase& test_case : suite.cases()) {
    if (is_canary(test_case)) continue;
    const GoogleTestName name = googletest_name(test_case.id);
    testing::RegisterTest(name.suite.c_str(), name.test.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                          [&suite, &test_case, shared]() -> testing::Test* {
                            return new RegisteredCase(suite, test_case, shared);
                          });
    ++registered;
  }
  return registered;
}

}  // namespace fieldproof::conformance
