#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "conformance/covering_array.hpp"
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

// What an item of a PICS is tried with: both truths; of a number or time the ends of its range and what is
// next to them. Nothing of a text: what it says the reference is not.
inline std::vector<judge::Pics::Answer> answers_to_try(const judge::PicsItem& item) {
  std::vector<judge::Pics::Answer> answers;
  if (item.kind == judge::PicsKind::truth) answers = {false, true};
  if (item.kind == judge::PicsKind::number || item.kind == judge::PicsKind::duration) {
    for (const std::int64_t one : std::set{item.least, item.least + 1, item.most - 1, item.most}) {
      if (one < item.least || one > item.most) continue;
      if (item.kind == judge::PicsKind::number)
        answers.emplace_back(one);
      else
        answers.emplace_back(kernel::Duration{one});
    }
  }
  return answers;
}

// The cases of a role in which its reference is accused where a PICS declares any two answers together. What
// contradicts itself the suite refuses; what a setup cannot show a case leaves open.
inline std::vector<std::string> false_alarms_of_answers(const Suite& suite, const RoleRow& role,
                                                        unsigned one_of_if_sanitized) {
  std::vector<judge::PicsItem> items = role.pics_items;
  std::erase_if(items, [](const judge::PicsItem& item) { return answers_to_try(item).empty(); });
  std::vector<std::size_t> values;
  for (const judge::PicsItem& item : items) values.push_back(answers_to_try(item).size());
  const auto setup_of = [&](const ValueRow& row) {
    Setup setup;
    setup.volume = Volume::quick;
    setup.pics.emplace();
    for (std::size_t n = 0; n < row.size(); ++n)
      setup.pics->declare(items[n].name, answers_to_try(items[n]).at(row[n]));
    return setup;
  };
  const auto is_of_role = [&](const TestCase& one) { return one.role() == role.name && !is_canary(one); };
  const auto may_be = [&](const ValueRow& row) {
    try {
      const Setup setup = setup_of(row);
      for (const TestCase& one : suite.cases())
        if (is_of_role(one)) suite.check(one, setup);
      return true;
    } catch (const kernel::Error&) {
      return false;
    }
  };
  std::vector<std::string> accused;
  kernel::FewerIfSanitized few(one_of_if_sanitized);
  for (const ValueRow& row : covering_array(values, may_be, kernel::Random(1)).rows) {
    if (few.leaves_out()) continue;
    const Setup setup = setup_of(row);
    for (const TestCase& one : suite.cases()) {
      if (!is_of_role(one)) continue;
      const judge::CaseResult result = run_case({&suite, &one}, setup).outcome.result;
      if (result.verdict < judge::Verdict::fail) continue;
      accused.push_back(fmt::format("{}: {} with", one.id, result.reason));
      for (std::size_t n = 0; n < row.size(); ++n)
        accused.back() += fmt::format(" {}={}", items[n].name, row[n]);
    }
  }
  return accused;
}

inline std::vector<std::string> false_alarms_of_answers(const Suite& suite, unsigned one_of_if_sanitized) {
  std::vector<std::string> accused;
  for (const RoleRow& role : suite.role_rows())
    for (std::string& one : false_alarms_of_answers(suite, role, one_of_if_sanitized))
      accused.push_back(std::move(one));
  return accused;
}

}  // namespace fieldproof::conformance
