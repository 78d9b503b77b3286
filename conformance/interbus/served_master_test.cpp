// Subject: masters that are called as an implementation outside is, by calls and items alone: the suite
// judges them to the bit as it does inside. In this process; cli proves the same of a process of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "conformance/interbus/master_cases.hpp"
#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/runner.hpp"
#include "harness/kernel/sanitized.hpp"
#include "protocols/interbus/attached_master.hpp"
#include "protocols/interbus/master.hpp"

namespace fieldproof::conformance {
namespace {

using interbus::AttachedMaster;
using interbus::MasterConfiguration;
using interbus::ServedMaster;

const Suite& inside() {
  static const auto suite = interbus_suite();
  return *suite;
}

// Plays a master by name as one outside; an empty name is the reference.
std::unique_ptr<Suite> outside(const std::string& mutant) {
  const Attach attach = [mutant](const iut::RoleName&,
                                 const IutRequest& request) -> std::optional<iut::Attachment> {
    if (request.uri != "outside") return std::nullopt;
    const auto served = std::make_shared<ServedMaster>([mutant](const MasterConfiguration& told) {
      return mutant.empty() ? std::make_unique<interbus::Master>(told) : master_mutants().make(mutant, told);
    });
    return iut::Attachment{served.get(), served, {}};
  };
  return interbus_suite({.attach = attach});
}

Setup setup_of(const std::string& uri) {
  Setup setup;
  setup.implementations.push_back({"master", 0, uri});
  setup.seed = 1;
  setup.volume = Volume::quick;
  return setup;
}

void expect_equal(const TestCase& test_case, const Outcome& outside, const Outcome& inside) {
  EXPECT_EQ(outside.result.verdict, inside.result.verdict) << test_case.id << outside.result.reason;
  EXPECT_EQ(outside.result.reason, inside.result.reason) << test_case.id;
  // Limits of the ring are no settings that an implementation outside is told: there it scans on.
  if (test_case.id == "interbus/master/compared/each_value_of_each_word" ||
      test_case.id == "interbus/master/compared/drawn_sequences" ||
      test_case.id == "interbus/master/derived/each_command_in_each_state")
    return;
  EXPECT_EQ(outside.result.fingerprint, inside.result.fingerprint) << test_case.id;
}

TEST(ServedMasters, ReferenceIsJudgedInEveryCaseAsInside) {
  const auto suite = outside("");
  int judged = 0;
  kernel::FewerIfSanitized few(8);
  for (const TestCase& test_case : suite->cases()) {
    if (test_case.role() == "slave" || few.leaves_out()) continue;
    ++judged;
    expect_equal(test_case, suite->run(test_case, setup_of("outside")),
                 inside().run(test_case, setup_of("ref")));
  }
  EXPECT_GT(judged, kernel::kIsSanitized ? 5 : 40);
}

// In the cases that name it.
class ServedMutants : public testing::TestWithParam<std::string> {};

TEST_P(ServedMutants, AreJudgedAsInside) {
  const auto suite = outside(GetParam());
  int judged = 0;
  for (const TestCase& test_case : suite->cases()) {
    // With fewer sequences under sanitizers a derived case need not find it.
    if (kernel::kIsSanitized && test_case.id.find("/derived/") != std::string::npos) continue;
    if (test_case.role() != "master" ||
        std::ranges::count(test_case.catches, GetParam(), &MustCatch::mutant) == 0)
      continue;
    ++judged;
    const Outcome outcome = suite->run(test_case, setup_of("outside"));
    EXPECT_EQ(outcome.result.verdict, judge::Verdict::fail) << test_case.id;
    expect_equal(test_case, outcome, inside().run(test_case, setup_of("mutant:" + GetParam())));
  }
  EXPECT_GT(judged, 0);
}

std::vector<std::string> mutant_names() {
  std::vector<std::string> names;
  for (const Mutant& one : master_mutants().mutants()) {
    if (!one.is_for_check) names.push_back(one.name);  // no case names those
  }
  return kernel::fewer_if_sanitized(4, std::move(names));
}

INSTANTIATE_TEST_SUITE_P(All, ServedMutants, testing::ValuesIn(mutant_names()),
                         [](const testing::TestParamInfo<std::string>& one) { return one.param; });

}  // namespace
}  // namespace fieldproof::conformance
