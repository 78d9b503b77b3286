#include "conformance/judging.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "harness/kernel/error.hpp"

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
  judge.use_decode([](kernel::Time) { return std::vector<std::string>{"cycle 1: data"}; });
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

// The example, with a part of it that nobody could verify.
TestCase example_with_detail() {
  TestCase test_case = example();
  test_case.details = {{{"our choice", "the coding", judge::Standing::own}, {"not_marked", "not_told"}}};
  return test_case;
}

judge::CaseResult result_of(const TestCase& test_case, const std::function<void(CaseJudge&)>& procedure) {
  CaseJudge judge(test_case);
  return judge.run_procedure(procedure);
}

TEST(CaseJudge, a_finding_rests_on_the_detail_that_its_reason_belongs_to) {
  const TestCase test_case = example_with_detail();
  for (const std::string_view reason : {"not_marked", "not_told"}) {
    const auto result = result_of(test_case, [&](CaseJudge& j) { j.fail(reason, {{"a mark"}, "none"}); });
    EXPECT_EQ(result.findings.at(0).reference.source, "our choice");
    EXPECT_EQ(result.reference.source, "our choice");
    EXPECT_FALSE(judge::is_verified(result.reference.standing));
  }
  const auto other = result_of(test_case, [](CaseJudge& j) { j.fail("lost", {{"all"}, "one less"}); });
  EXPECT_EQ(other.findings.at(0).reference.source, "a source");
  EXPECT_EQ(other.reference.standing, judge::Standing::calc);
}

TEST(CaseJudge, a_pass_rests_on_every_detail_and_so_does_one_with_a_warning) {
  const TestCase test_case = example_with_detail();
  const auto passed = result_of(test_case, [](CaseJudge&) {});
  EXPECT_EQ(passed.reference.source, "a source");
  EXPECT_EQ(passed.reference.clause, "a clause; our choice: the coding");
  EXPECT_EQ(passed.reference.standing, judge::Standing::own);
  const auto warned = result_of(test_case, [](CaseJudge& j) { j.warn("slow", {{"fast"}, "slow"}); });
  EXPECT_EQ(warned.verdict, judge::Verdict::warn);
  EXPECT_EQ(warned.reference.standing, judge::Standing::own);
  EXPECT_EQ(warned.findings.at(0).reference.standing, judge::Standing::calc);
  EXPECT_EQ(result_of(example(), [](CaseJudge&) {}).reference.standing, judge::Standing::calc);
}

TEST(CaseJudge, describes_only_what_does_not_hold) {
  const TestCase test_case = example();
  CaseJudge judge(test_case);
  int described = 0;
  const auto describe = [&] {
    ++described;
    return Mismatch{{"a", "b"}, "c", kernel::kStart + kernel::kMicrosecond, "octet 3", {"bits"}};
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

TEST(CaseJudge, blames_the_implementation_for_its_own_errors_only) {
  const TestCase test_case = example();
  CaseJudge judge(test_case);
  const judge::CaseResult result = judge.run_procedure(
      [](CaseJudge&) { throw kernel::Error(kernel::ErrorKind::implementation, "it has gone"); });
  EXPECT_EQ(result.verdict, judge::Verdict::fail);
  EXPECT_EQ(result.reason, "implementation_misbehaves");
  ASSERT_EQ(result.findings.size(), 1U);
  EXPECT_EQ(result.findings[0].actual, "it has gone");
  EXPECT_THROW(judge.run_procedure(
                   [](CaseJudge&) { throw kernel::Error(kernel::ErrorKind::configuration, "a file"); }),
               kernel::Error);
}

}  // namespace
}  // namespace fieldproof::conformance
