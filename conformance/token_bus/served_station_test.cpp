// Subject: stations of the token bus that are called as an implementation outside is, by calls and items
// alone: the suite judges them to the bit as it does inside.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "conformance/token_bus/station_mutants.hpp"
#include "conformance/token_bus/suite.hpp"
#include "harness/kernel/sanitized.hpp"
#include "protocols/token_bus/attached_station.hpp"
#include "protocols/token_bus/token_station.hpp"

namespace fieldproof::conformance {
namespace {

// An empty name is the reference.
std::unique_ptr<Suite> token_suite_outside(const std::string& mutant) {
  SuiteGiven given;
  given.attach = [mutant](const iut::RoleName&, const IutRequest& request) -> std::optional<iut::Attachment> {
    if (request.uri != "outside") return std::nullopt;
    const auto device = std::make_shared<token_bus::ServedStation>(
        [mutant](const token_bus::StationConfiguration& configuration)
            -> std::unique_ptr<token_bus::StationDevice> {
          if (!mutant.empty()) return token_station_mutants().make(mutant, configuration);
          return std::make_unique<token_bus::TokenStation>(configuration);
        });
    return iut::Attachment{device.get(), device, {}};
  };
  return token_bus_suite(given);
}

judge::CaseResult judged_station(const Suite& suite, const TestCase& test_case, const std::string& uri) {
  Setup setup;
  setup.implementations.push_back({"station", 0, uri});
  setup.volume = Volume::quick;
  return suite.run(test_case, setup).result;
}

void expect_alike_outside(const Suite& outside, const Suite& inside, const TestCase& test_case,
                          const std::string& uri) {
  const judge::CaseResult there = judged_station(outside, test_case, "outside");
  const judge::CaseResult here = judged_station(inside, test_case, uri);
  EXPECT_EQ(there.verdict, here.verdict) << test_case.id << " " << uri << " " << there.reason;
  EXPECT_EQ(there.reason, here.reason) << test_case.id << " " << uri;
  EXPECT_EQ(there.fingerprint, here.fingerprint) << test_case.id << " " << uri;
}

TEST(ServedTokenStation, TheReferenceIsJudgedInEveryCaseAsInside) {
  const auto inside = token_bus_suite();
  const auto outside = token_suite_outside("");
  ASSERT_GT(inside->cases().size(), 40U);
  for (kernel::FewerIfSanitized few(4); const TestCase& test_case : inside->cases()) {
    if (!few.leaves_out()) expect_alike_outside(*outside, *inside, test_case, "ref");
  }
}

TEST(ServedTokenStation, MutantsAreJudgedAsInside) {
  const auto inside = token_bus_suite();
  for (kernel::FewerIfSanitized few(4); const Mutant& mutant : inside->mutants()) {
    if (few.leaves_out()) continue;  // the way out and back is the same for all
    const auto outside = token_suite_outside(mutant.name);
    for (const TestCase& test_case : inside->cases()) {
      if (std::ranges::count(test_case.catches, mutant.name, &MustCatch::mutant) > 0)
        expect_alike_outside(*outside, *inside, test_case, "mutant:" + mutant.name);
    }
  }
}

}  // namespace
}  // namespace fieldproof::conformance
