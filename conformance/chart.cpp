#include "conformance/chart.hpp"

#include <fmt/ranges.h>

#include <cctype>

namespace fieldproof::conformance::chart {
namespace {

void add_other(std::vector<std::string>& clauses, const std::string& clause) {
  if (!clause.empty() && (clauses.empty() || clauses.back() != clause)) clauses.push_back(clause);
}

std::string sentence(const std::vector<std::string>& clauses) {
  if (clauses.empty()) return {};
  std::string text = fmt::format("{}.", fmt::join(clauses, "; "));
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace

void Words::add(const std::string& stimulus, const std::string& expected) {
  add_other(stimuli, stimulus);
  add_other(expectations, expected);
  const char* const joint = stimulus.empty() || expected.empty() ? "" : "; ";
  const char* const label = expected.empty() ? "" : "expected: ";
  steps.push_back(fmt::format("{}{}{}{}", stimulus, joint, label, expected));
}

void Words::add_repeated(const Words& inner, const Rounds& times) {
  if (times.full == 1) {
    for (const std::string& one : inner.stimuli) add_other(stimuli, one);
  } else if (!inner.stimuli.empty()) {
    add_other(stimuli, fmt::format("{} times ({})", times.full, fmt::join(inner.stimuli, "; ")));
  }
  for (const std::string& one : inner.expectations) add_other(expectations, one);
  steps.insert(steps.end(), inner.steps.begin(), inner.steps.end());
}

void Words::tell(TestCase& test_case, const Rounds& rounds) const {
  test_case.stimulus = sentence(stimuli);
  if (rounds.full > 1) test_case.stimulus += fmt::format(" All of it {} times.", rounds.full);
  test_case.expected = sentence(expectations);
  for (const std::string& step : steps) {
    test_case.steps.push_back(fmt::format("{} of {}: {}", test_case.steps.size() + 1, steps.size(), step));
  }
}

}  // namespace fieldproof::conformance::chart
