#include "conformance/gtest_catalogue.hpp"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include "conformance/invented_case.hpp"
#include "conformance/suite_of_functions.hpp"

namespace fieldproof::conformance {
namespace {

using judge::Verdict;

Outcome outcome_of(Verdict verdict, std::string reason = {}) {
  Outcome outcome;
  outcome.result.verdict = verdict;
  outcome.result.reason = std::move(reason);
  return outcome;
}

// Registered before main, as a user's program does it; GoogleTest itself then runs these cases.
const SuiteOfFunctions& registered_suite() {
  static const SuiteOfFunctions& suite = []() -> const SuiteOfFunctions& {
    static SuiteOfFunctions made("registered", {"slave"});
    made.add(invented_case("registered/slave/data/word_is_latched"), [](const TestCase&, const Setup& setup) {
      EXPECT_EQ(setup.implementations.at(0).uri, "mutant:mine");
      return outcome_of(Verdict::pass);
    });
    made.add(invented_case("registered/slave/option/is_missing"), [](const TestCase&, const Setup&) {
      return outcome_of(Verdict::not_applicable, "has no such option");
    });
    made.add(invented_case("registered/slave/canary", {"canary"}),
             [](const TestCase&, const Setup&) { return outcome_of(Verdict::fail, "canary"); });
    return made;
  }();
  return suite;
}

const std::size_t kRegistered = register_with_googletest(registered_suite(), [](const TestCase&) {
  Setup setup;
  setup.implementations = {{"slave", 0, "mutant:mine"}};
  return setup;
});

const testing::TestInfo* find_test(const std::string& suite_name, const std::string& test_name) {
  const testing::UnitTest& unit = *testing::UnitTest::GetInstance();
  for (int i = 0; i < unit.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *unit.GetTestSuite(i);
    for (int j = 0; suite.name() == suite_name && j < suite.total_test_count(); ++j) {
      if (suite.GetTestInfo(j)->name() == test_name) return suite.GetTestInfo(j);
    }
  }
  return nullptr;
}

TEST(GoogleTestCatalogue, ShowsEveryCaseButTheCanaryByItsId) {
  EXPECT_EQ(kRegistered, 2U);
  EXPECT_NE(find_test("registered.slave.data", "word_is_latched"), nullptr);
  EXPECT_NE(find_test("registered.slave.option", "is_missing"), nullptr);
  EXPECT_EQ(find_test("registered.slave", "canary"), nullptr);
}

TEST(GoogleTestCatalogue, NamesKeepTheLastPartApart) {
  const GoogleTestName name = googletest_name("interbus/slave/data_cycle/x");
  EXPECT_EQ(name.suite, "interbus.slave.data_cycle");
  EXPECT_EQ(name.test, "x");
}

TEST(GoogleTestCatalogue, FailureTellsTheWholeFinding) {
  judge::CaseResult result;
  result.verdict = Verdict::fail;
  result.seed = 99;
  judge::Finding finding;
  finding.reason = "wrong_word";
  finding.requirement = "the word is latched after the check";
  finding.reference = {"a book", "table 5", judge::Standing::memory};
  finding.expected = {"0x1234", "0x0000"};
  finding.actual = "0x3412";
  finding.time = kernel::kStart + 3 * kernel::kMicrosecond;
  finding.first_difference = "bit 3";
  finding.decode = {"telegram 7"};
  result.findings = {finding};
  const std::string message = failure_message(invented_case("registered/slave/x"), result);
  for (const char* part : {"registered/slave/x (P-1): fail, seed of the case 99", "wrong_word", "3.000 us",
                           "the word is latched after the check", "a book, table 5 (unverified)",
                           "0x1234 | 0x0000", "0x3412", "bit 3", "telegram 7"}) {
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in\n" << message;
  }
}

}  // namespace
}  // namespace fieldproof::conformance
