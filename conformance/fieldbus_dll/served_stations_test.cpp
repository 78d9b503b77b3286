// Subject: stations of the data link that are called as an implementation outside is, by calls and items
// alone: the suite judges them to the bit as it does inside. In this process; cli proves the same of a
// process of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "conformance/fieldbus_dll/ff_mutants.hpp"
#include "conformance/fieldbus_dll/isa_mutants.hpp"
#include "conformance/fieldbus_dll/suite.hpp"
#include "harness/kernel/sanitized.hpp"
#include "protocols/fieldbus_dll/attached_ff_device.hpp"
#include "protocols/fieldbus_dll/attached_isa_device.hpp"
#include "protocols/fieldbus_dll/ff_las.hpp"
#include "protocols/fieldbus_dll/isa_las.hpp"

namespace fieldproof::conformance {
namespace {

using fieldbus_dll::AttachedFfDevice;
using fieldbus_dll::AttachedIsaDevice;
using fieldbus_dll::FfConfiguration;
using fieldbus_dll::FfDevice;
using fieldbus_dll::IsaConfiguration;
using fieldbus_dll::IsaDevice;
using fieldbus_dll::ServedFfDevice;
using fieldbus_dll::ServedIsaDevice;

const Suite& suite_inside() {
  static const auto suite = fieldbus_dll_suite();
  return *suite;
}

// An empty name is the reference.
std::unique_ptr<FfDevice> station_named(const std::string& role, const std::string& mutant,
                                        const FfConfiguration& configuration) {
  const bool is_las = role == "ff_las";
  if (!mutant.empty()) return (is_las ? ff_las_mutants() : ff_device_mutants()).make(mutant, configuration);
  if (is_las) return std::make_unique<fieldbus_dll::FfLas>(configuration);
  return std::make_unique<fieldbus_dll::FfStation>(configuration);
}
std::unique_ptr<IsaDevice> station_named(const std::string& role, const std::string& mutant,
                                         const IsaConfiguration& configuration) {
  const bool is_las = role == "isa_las";
  if (!mutant.empty()) return (is_las ? isa_las_mutants() : isa_dle_mutants()).make(mutant, configuration);
  if (is_las) return std::make_unique<fieldbus_dll::IsaLas>(configuration);
  return std::make_unique<fieldbus_dll::IsaDle>(configuration);
}

// Plays the station as one outside.
template <typename Served, typename Configuration>
iut::Attachment served(const std::string& role, const std::string& mutant) {
  const auto device = std::make_shared<Served>(
      [role, mutant](const Configuration& told) { return station_named(role, mutant, told); });
  return {device.get(), device, {}};
}

std::unique_ptr<Suite> suite_outside(const std::string& role, const std::string& mutant) {
  SuiteGiven given;
  given.attach = [role, mutant](const iut::RoleName&,
                                const IutRequest& request) -> std::optional<iut::Attachment> {
    if (request.uri != "outside") return std::nullopt;
    if (role.starts_with("isa")) return served<ServedIsaDevice, IsaConfiguration>(role, mutant);
    return served<ServedFfDevice, FfConfiguration>(role, mutant);
  };
  return fieldbus_dll_suite(given);
}

Outcome outcome_of(const Suite& suite, const TestCase& test_case, const std::string& uri) {
  Setup setup;
  setup.implementations.push_back({test_case.role(), 0, uri});
  setup.seed = 1;
  setup.volume = Volume::quick;
  setup.record = true;
  return suite.run(test_case, setup);
}

// Without the order of what was recorded at one instant: who begins at the very end of another transmission
// is recorded before or after it.
std::vector<std::string> line_of(const Outcome& outcome) {
  std::vector<std::string> lines = outcome.recording.lines();
  std::ranges::sort(lines);
  return lines;
}

void expect_judged_alike(const TestCase& test_case, const Outcome& outside, const Outcome& inside) {
  EXPECT_EQ(outside.result.verdict, inside.result.verdict) << test_case.id << outside.result.reason;
  EXPECT_EQ(outside.result.reason, inside.result.reason) << test_case.id;
  if (outside.result.fingerprint == inside.result.fingerprint) return;
  EXPECT_FALSE(outside.recording.trace.records.empty()) << test_case.id;
  EXPECT_EQ(line_of(outside), line_of(inside)) << test_case.id;
}

class ServedLinkRoles : public testing::TestWithParam<std::string> {};

TEST_P(ServedLinkRoles, ReferenceIsJudgedInEveryCaseAsInside) {
  const auto suite = suite_outside(GetParam(), "");
  int judged = 0;
  for (kernel::FewerIfSanitized few(3); const TestCase& test_case : suite->cases()) {
    if (test_case.role() != GetParam() || few.leaves_out()) continue;
    // Those of a basic station again.
    if (kernel::kIsSanitized && test_case.id.find("/standby/") != std::string::npos) continue;
    ++judged;
    expect_judged_alike(test_case, outcome_of(*suite, test_case, "outside"),
                        outcome_of(suite_inside(), test_case, "ref"));
  }
  EXPECT_GT(judged, kernel::kIsSanitized ? 5 : 10);
}

// In the cases that name them.
TEST_P(ServedLinkRoles, MutantsAreJudgedAsInside) {
  unsigned number = 0;
  for (const Mutant& mutant : suite_inside().mutants()) {
    // What shows in sequences only no case names.
    if (mutant.role != GetParam() || mutant.is_for_check) continue;
    if (kernel::kIsSanitized && number++ % 4 != 0) continue;  // the way out and back is the same for all
    const auto suite = suite_outside(GetParam(), mutant.name);
    int judged = 0;
    for (const TestCase& test_case : suite->cases()) {
      if (test_case.role() != GetParam() ||
          std::ranges::count(test_case.catches, mutant.name, &MustCatch::mutant) == 0)
        continue;
      ++judged;
      const Outcome outcome = outcome_of(*suite, test_case, "outside");
      // With fewer sequences under sanitizers a derived case need not find it.
      if (!kernel::kIsSanitized || test_case.id.find("/derived/") == std::string::npos) {
        EXPECT_EQ(outcome.result.verdict, judge::Verdict::fail) << test_case.id << " " << mutant.name;
      }
      expect_judged_alike(test_case, outcome, outcome_of(suite_inside(), test_case, "mutant:" + mutant.name));
    }
    EXPECT_GT(judged, 0) << mutant.name;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ServedLinkRoles, testing::Values("isa_dle", "isa_las", "ff_device", "ff_las"),
                         [](const testing::TestParamInfo<std::string>& one) { return one.param; });

}  // namespace
}  // namespace fieldproof::conformance
