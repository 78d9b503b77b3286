#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/runner.hpp"
#include "harness/kernel/campaign.hpp"

// For tests of suites: the references pass, whatever is drawn.
namespace fieldproof::conformance {

// FIELDPROOF_SEEDS says how many, where these are too few.
inline std::uint64_t many_seeds() {
  return kernel::campaign_count("FIELDPROOF_SEEDS", 10);
}
// Of derived cases, which are many sequences each, one seed in so many.
constexpr std::uint64_t kFewerSeedsOfSequences = 7;

// The cases in which the references of a suite get such a verdict; of one role, or of all.
template <typename IsSuch>
std::vector<std::string> cases_where(const Suite& suite, const Setup& setup, IsSuch is_such,
                                     std::string_view role = {}) {
  std::vector<std::string> cases;
  for (const TestCase& test_case : suite.cases()) {
    if (is_canary(test_case) || (!role.empty() && test_case.role() != role)) continue;
    if (setup.seed % kFewerSeedsOfSequences != 1 && has_tag(test_case, "derived")) continue;
    const judge::CaseResult result = run_case({&suite, &test_case}, setup).outcome.result;
    if (is_such(result.verdict))
      cases.push_back(fmt::format("{} seed {}: {}", test_case.id, setup.seed, result.reason));
  }
  return cases;
}

// The cases that they do not pass with a seed, at quick volume. A warn is a pass that a weakness of the
// protocol goes with; it accuses nobody.
inline std::vector<std::string> false_alarms(const Suite& suite, std::uint64_t seed) {
  Setup setup;
  setup.seed = seed;
  setup.volume = Volume::quick;
  return cases_where(suite, setup, [](judge::Verdict verdict) {
    return verdict != judge::Verdict::pass && verdict != judge::Verdict::warn;
  });
}

}  // namespace fieldproof::conformance
