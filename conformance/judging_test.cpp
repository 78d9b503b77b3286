#include "conformance/judging.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fieldproof::conformance {
namespace {

TestCase example() {
  TestCase test_case;
  test_case.id = "interbus/master/data_cycle/example";
  test_case.purpose = "IM-00";
  test_case.requirement = "an example holds";
  test_case.reference = {"a source", "a clause", judge::Standing::calc};
  return test_case;
}

TEST(CaseJudge, passes_without_a_finding_and_keeps_measurements) {
  const TestCase test_case = example();
  CaseJudge judge(test_case);
  const judge::CaseResult result = judge.run_procedure([](CaseJudge& j) {
    j.expect(true, "never", "x", "y");
    j.expect_equal(3U, 3, "never", "count");
    j.expect_between("cycle time", "us", 755.0, 754.0, 756.0, "never");
    j.measure("delay", "bit", 3);
  });
  EXPECT_EQ(result.verdict, judge::Verdict::pass);
  EXPECT_EQ(result.reason, "");
  EXPECT_EQ(result.purpose, "IM-00");
  EXPECT_EQ(result.reference.source, "a source");
  ASSERT_EQ(result.measurements.size(), 2U);
  EXPECT_EQ(result.measurements[0].low, 754.0);
  EXPECT_EQ(result.measurements[1].high, 3.0);
}

TEST(CaseJudge, ends_at_the_first_failure) {
  const TestCase test_case = example();
  CaseJudge judge(test_case);
  bool went_on = false;
  judge.use_clock([] { return kernel::kStart + kernel::kSecond; });
  judge.use_decode([] { return std::vector<std::string>{"cycle 1: data"}; });
  const judge::CaseResult result = judge.run_procedure([&](CaseJudge& j) {
    j.warn("slow", {{"fast"}, "slow"});
    j.expect_equal(2U, 3, "too_few", "stations");
    went_on = true;
  });
  EXPECT_FALSE(went_on);
  EXPECT_EQ(result.verdict, judge::Verdict::fail);
  EXPECT_EQ(result.reason, "too_few");
  ASSERT_EQ(result.findings.size(), 2U);
  const judge::Finding& finding = result.findings[1];
  EXPECT_EQ(finding.expected, std::vector<std::string>{"stations: 3"});
  EXPECT_EQ(finding.actual, "stations: 2");
  EXPECT_EQ(finding.time, kernel::kStart + kernel::kSecond);
  EXPECT_EQ(finding.decode, std::vector<std::string>{"cycle 1: data"});
  EXPECT_EQ(finding.requirement, "an example holds");
}

TEST(CaseJudge, describes_only_what_does_not_hold) {
  const TestCase test_case = example();
  CaseJudge judge(test_case);
  int described = 0;
  const auto describe = [&] {
    ++described;
    return Sighting{{"a", "b"}, "c", kernel::kStart + kernel::kMicrosecond, "octet 3", {"bits"}};
  };
  const judge::CaseResult result = judge.run_procedure([&](CaseJudge& j) {
    j.expect(true, "never", describe);
    j.expect(false, "wrong", describe);
  });
  EXPECT_EQ(described, 1);
  EXPECT_EQ(result.findings.at(0).first_difference, "octet 3");
  EXPECT_EQ(result.findings.at(0).time, kernel::kStart + kernel::kMicrosecond);
}

TEST(CaseJudge, a_value_outside_or_no_number_fails_and_inconclusive_is_no_pass) {
  const TestCase test_case = example();
  for (const double value : {0.9, 2.1, std::numeric_limits<double>::quiet_NaN()}) {
    CaseJudge judge(test_case);
    const judge::CaseResult result =
        judge.run_procedure([&](CaseJudge& j) { j.expect_between("x", "s", value, 1, 2, "outside"); });
    EXPECT_EQ(result.verdict, judge::Verdict::fail);
    EXPECT_EQ(result.reason, "outside");
  }
  CaseJudge judge(test_case);
  const judge::CaseResult result = judge.run_procedure(
      [](CaseJudge& j) { j.inconclusive("not_shown", {{"a status telegram"}, "nothing"}); });
  EXPECT_EQ(result.verdict, judge::Verdict::inconclusive);
  EXPECT_EQ(result.reason, "not_shown");
}

}  // namespace
}  // namespace fieldproof::conformance
