// Subject: the slave suite on the reference, on every deviation and at other positions of the ring.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "conformance/interbus/slave_cases.hpp"
#include "conformance/interbus/slave_deviations.hpp"
#include "conformance/matrix.hpp"
#include "conformance/suite_of_functions.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

SlaveSetting setting_for(const conformance::Setup& setup) {
  SlaveSetting setting;
  setting.seed = setup.seed;
  setting.volume = setup.volume;
  for (const Assignment& assignment : setup.implementations) {
    if (!assignment.uri.starts_with("deviant:")) continue;
    setting.make_slave = [name =
                              assignment.uri.substr(8)](const interbus::SlaveConfiguration& configuration) {
      return make_slave_deviation(name, configuration);
    };
  }
  return setting;
}

const Suite& suite_of_slaves() {
  static const auto suite = [] {
    auto made = std::make_unique<SuiteOfFunctions>("interbus", std::vector<std::string>{"slave"});
    for (const SlaveCase& slave_case : slave_cases()) {
      made->add(slave_case.test_case, [&slave_case](const TestCase&, const conformance::Setup& setup) {
        Outcome outcome;
        outcome.result = run_slave_case(slave_case, setting_for(setup));
        return outcome;
      });
    }
    for (const Deviation& deviation : slave_deviations()) made->add(deviation);
    return made;
  }();
  return *suite;
}

std::string what_failed(const judge::CaseResult& result) {
  std::string text(judge::name(result.verdict));
  text += " " + result.reason;
  for (const judge::Finding& finding : result.findings) {
    for (const std::string& expected : finding.expected) text += "\n  expected " + expected;
    text += "\n  actual   " + finding.actual + "\n  at       " + finding.first_difference;
    for (const std::string& line : finding.decode) text += "\n    " + line;
  }
  return text;
}

void expect_reference_passes(const SlaveSetting& setting) {
  for (const SlaveCase& slave_case : slave_cases()) {
    if (is_canary(slave_case.test_case)) continue;
    const judge::CaseResult result = run_slave_case(slave_case, setting);
    EXPECT_EQ(result.verdict, judge::Verdict::pass)
        << slave_case.test_case.id << " seed " << setting.seed << ": " << what_failed(result);
  }
}

TEST(SlaveSuite, NoFalseAlarmInHundredSeeds) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SlaveSetting setting;
    setting.seed = seed;
    setting.volume = Volume::quick;
    expect_reference_passes(setting);
    if (HasFailure()) return;
  }
}

TEST(SlaveSuite, NoFalseAlarmAtOtherPositions) {
  for (const auto& [position, stations] : {std::pair{2, 3}, {1, 2}, {3, 3}, {5, 8}}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      SlaveSetting setting;
      setting.seed = seed;
      setting.volume = Volume::quick;
      setting.position = position;
      setting.stations = stations;
      expect_reference_passes(setting);
      if (HasFailure()) return;
    }
  }
}

TEST(SlaveSuite, NoHoleInTheMatrix) {
  MatrixPlan plan;
  plan.jobs = 2;
  const Matrix matrix = make_matrix(suite_of_slaves(), plan);
  EXPECT_TRUE(matrix.is_complete);
  for (const Hole& hole : matrix.holes)
    ADD_FAILURE() << hole.case_id << " x " << hole.deviation << ": " << hole.sentence;
}

TEST(SlaveSuite, EachDeviationIsCaughtAtAnotherPosition) {
  for (const SlaveCase& slave_case : slave_cases()) {
    for (const Catch& declared : slave_case.test_case.catches) {
      SlaveSetting setting = setting_for({});
      setting.volume = Volume::quick;
      setting.position = 2;
      setting.stations = 3;
      setting.make_slave = [&](const interbus::SlaveConfiguration& configuration) {
        return make_slave_deviation(declared.deviation, configuration);
      };
      const judge::CaseResult result = run_slave_case(slave_case, setting);
      EXPECT_EQ(result.verdict, judge::Verdict::fail) << slave_case.test_case.id << " " << declared.deviation;
      EXPECT_EQ(result.reason, declared.reason) << slave_case.test_case.id << " " << declared.deviation;
    }
  }
}

TEST(SlaveSuite, TheCanaryFails) {
  for (const SlaveCase& slave_case : slave_cases()) {
    if (!is_canary(slave_case.test_case)) continue;
    EXPECT_EQ(run_slave_case(slave_case, {}).verdict, judge::Verdict::fail);
  }
}

TEST(SlaveSuite, EveryTestPurposeHasACaseAndEveryMutantADeviation) {
  std::set<std::string> purposes;
  std::set<std::string> ids;
  for (const SlaveCase& slave_case : slave_cases()) {
    const TestCase& test_case = slave_case.test_case;
    purposes.insert(test_case.purpose);
    EXPECT_TRUE(ids.insert(test_case.id).second) << test_case.id;
    EXPECT_EQ(test_case.role(), "slave") << test_case.id;
    for (const std::string* text : {&test_case.requirement, &test_case.stimulus, &test_case.expected})
      EXPECT_FALSE(text->empty()) << test_case.id;
  }
  for (unsigned n = 1; n <= 42; ++n) {
    const std::string number = n < 10 ? "0" + std::to_string(n) : std::to_string(n);
    EXPECT_TRUE(purposes.contains("IS-" + number)) << "IS-" << number;
  }
  std::set<std::string> mutants;
  for (const Deviation& deviation : slave_deviations()) mutants.insert(deviation.mutant);
  for (unsigned n = 1; n <= 22; ++n) EXPECT_TRUE(mutants.contains("MS" + std::to_string(n))) << "MS" << n;
}

TEST(SlaveSuite, TheSameSeedRepeatsBitForBit) {
  for (const SlaveCase& slave_case : slave_cases()) {
    SlaveSetting setting;
    setting.volume = Volume::quick;
    EXPECT_EQ(run_slave_case(slave_case, setting).fingerprint,
              run_slave_case(slave_case, setting).fingerprint)
        << slave_case.test_case.id;
  }
}

TEST(SlaveSuite, UnknownDeviationNamesItsNeighbours) {
  try {
    make_slave_deviation("crc_preset_zer", {});
    FAIL();
  } catch (const kernel::Error& error) {
    EXPECT_NE(std::string(error.what()).find("crc_preset_zero"), std::string::npos);
  }
}

}  // namespace
}  // namespace fieldproof::conformance
