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

// The cases in which the references of a suite get such a verdict.
template <typename IsSuch>
std::vector<std::string> cases_where(const Suite& suite, const Setup& setup, IsSuch is_such) {
  std::vector<std::string> cases;
  for (const TestCase& test_case : suite.cases()) {
    if (is_canary(test_case)) continue;
    const judge::CaseResult result = run_case({&suite, &test_case}, setup).outcome.result;
    if (is_such(result.verdict))
      cases.push_back(fmt::format("{} seed {}: {}", test_case.id, setup.seed, result.reason));
  }
  return cases;
}

// The cases that they do not pass with a seed, at quick volume.
inline std::vector<std::string> false_alarms(const Suite& suite, std::uint64_t seed) {
  Setup setup;
  setup.seed = seed;
  setup.volume = Volume::quick;
  return cases_where(suite, setup, [](judge::Verdict verdict) { return verdict != judge::Verdict::pass; });
}

// The cases in which the references of a suite are accused when a PICS declares the other answer of a truth,
// or a number or time at an end of its range; one answer at a time. Where answers contradict each other a
// case may leave it open, and the suite may refuse them.
inline std::vector<std::string> false_alarms_at_ends(const Suite& suite, unsigned one_of_if_sanitized) {
  const auto is_accused = [](judge::Verdict verdict) { return verdict >= judge::Verdict::fail; };
  std::vector<std::string> cases;
  kernel::FewerIfSanitized few(one_of_if_sanitized);
  const auto try_answer = [&](const std::string& item, judge::Pics::Answer answer) {
    if (few.leaves_out()) return;
    Setup setup;
    setup.volume = Volume::quick;
    setup.pics.emplace().declare(item, std::move(answer));
    try {
      for (std::string& one : cases_where(suite, setup, is_accused))
        cases.push_back(fmt::format("{} with {}", std::move(one), item));
    } catch (const kernel::Error&) {
      // Two answers that do not fit together are refused.
    }
  };
  for (const judge::PicsItem& item : suite.pics_items()) {
    switch (item.kind) {
      case judge::PicsKind::truth:
        for (const bool answer : {false, true}) try_answer(item.name, answer);
        break;
      case judge::PicsKind::number:
        for (const std::int64_t end : {item.least, item.most}) try_answer(item.name, end);
        break;
      case judge::PicsKind::duration:
        for (const std::int64_t end : {item.least, item.most}) try_answer(item.name, kernel::Duration{end});
        break;
      case judge::PicsKind::text:
        break;  // what a reference is not
    }
  }
  return cases;
}

}  // namespace fieldproof::conformance
