// The master suite on the reference and on every deviation. The joint tests of all suites are elsewhere; here
// every declared catch is shown.
#include "conformance/interbus/master_cases.hpp"

#include <gtest/gtest.h>

#include <set>

#include "conformance/interbus/master_deviations.hpp"
#include "conformance/runner.hpp"

namespace fieldproof::conformance {
namespace {

judge::CaseResult run(const MasterCase& master_case, std::string_view uri, std::uint64_t seed,
                      Volume volume) {
  CaseJudge judge(master_case.test_case);
  MasterBench bench(make_master(uri), case_seed(seed, master_case.test_case.id), volume);
  return judge.run_procedure([&](CaseJudge& j) { master_case.procedure(bench, j); });
}

std::string told(const judge::CaseResult& result) {
  std::string text = result.id + ": " + std::string(judge::name(result.verdict)) + " " + result.reason;
  for (const judge::Finding& finding : result.findings) {
    for (const std::string& expected : finding.expected) text += "\n  expected " + expected;
    text += "\n  actual " + finding.actual;
    for (const std::string& line : finding.decode) text += "\n    " + line;
  }
  return text;
}

TEST(MasterSuite, names_every_purpose_and_every_mutant) {
  std::set<std::string> purposes;
  std::set<std::string> ids;
  for (const MasterCase& c : master_cases()) {
    purposes.insert(c.test_case.purpose);
    EXPECT_TRUE(ids.insert(c.test_case.id).second) << c.test_case.id;
  }
  for (int n = 1; n <= 40; ++n) {
    EXPECT_TRUE(purposes.contains(n < 10 ? "IM-0" + std::to_string(n) : "IM-" + std::to_string(n))) << n;
  }
  std::set<std::string> mutants;
  for (const Deviation& deviation : master_deviations()) mutants.insert(deviation.mutant);
  for (int n = 1; n <= 22; ++n) EXPECT_TRUE(mutants.contains("MM" + std::to_string(n))) << n;
}

TEST(MasterSuite, the_reference_passes_at_quick_volume_in_several_seeds) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const MasterCase& c : master_cases()) {
      const judge::CaseResult result = run(c, "ref", seed, Volume::quick);
      EXPECT_EQ(result.verdict, is_canary(c.test_case) ? judge::Verdict::fail : judge::Verdict::pass)
          << "seed " << seed << "\n"
          << told(result);
    }
  }
}

TEST(MasterSuite, every_declared_catch_happens_for_its_reason) {
  std::set<std::string> caught;
  for (const MasterCase& c : master_cases()) {
    EXPECT_EQ(c.test_case.catches.empty(), is_canary(c.test_case)) << c.test_case.id;
    for (const Catch& declared : c.test_case.catches) {
      const judge::CaseResult result = run(c, "deviant:" + declared.deviation, 1, Volume::quick);
      EXPECT_EQ(result.reason, declared.reason) << declared.deviation << "\n" << told(result);
      caught.insert(declared.deviation);
    }
  }
  for (const Deviation& deviation : master_deviations())
    EXPECT_TRUE(caught.contains(deviation.name)) << deviation.name;
}

}  // namespace
}  // namespace fieldproof::conformance
