#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "conformance/runner.hpp"
#include "harness/kernel/sanitized.hpp"

// For tests of suites: the references pass, whatever is drawn.
namespace fieldproof::conformance {

inline constexpr std::uint64_t kManySeeds = kernel::kIsSanitized ? 1 : 100;

// The cases that the references of a suite do not pass with a seed, at quick volume.
inline std::vector<std::string> false_alarms(const Suite& suite, std::uint64_t seed) {
  Setup setup;
  setup.seed = seed;
  setup.volume = Volume::quick;
  std::vector<std::string> alarms;
  for (const TestCase& test_case : suite.cases()) {
    if (is_canary(test_case)) continue;
    const CaseRun done = run_case({&suite, &test_case}, setup);
    if (done.outcome.result.verdict == judge::Verdict::pass) continue;
    alarms.push_back(fmt::format("{} seed {}: {}", test_case.id, seed, done.outcome.result.reason));
  }
  return alarms;
}

}  // namespace fieldproof::conformance
