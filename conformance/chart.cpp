#include "conformance/chart.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace fieldproof::conformance::chart {
namespace {

std::string joined(const std::vector<std::string>& clauses) {
  std::vector<std::string> listed;
  for (auto clause = clauses.begin(); clause != clauses.end();) {
    const auto next = std::find_if(clause, clauses.end(), [&](const auto& each) { return each != *clause; });
    const auto count = next - clause;
    listed.push_back(count > 1 ? fmt::format("{}, {} times", *clause, count) : *clause);
    clause = next;
  }
  return fmt::format("{}", fmt::join(listed, "; "));
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

// "for each register, 20 times"
std::string repetition(const Rounds& rounds, const std::string& over) {
  std::string text = over.empty() ? "" : fmt::format("for {}", over);
  if (rounds.full > 1) text += fmt::format("{}{} times", text.empty() ? "" : ", ", rounds.full);
  return text;
}

std::string line_of(const std::string& stimulus, const std::string& expected) {
  const char* const joint = stimulus.empty() || expected.empty() ? "" : "; ";
  const char* const label = expected.empty() ? "" : "expected: ";
  return fmt::format("{}{}{}{}", stimulus, joint, label, expected);
}

}  // namespace

void Words::add(const std::string& stimulus, const std::string& expected) {
  if (!stimulus.empty()) stimuli.push_back(stimulus);
  if (!expected.empty()) expectations.push_back(expected);
  steps.push_back(line_of(stimulus, expected));
}

void Words::add_repeated(const Words& inner, const Rounds& times) {
  if (times.full == 1) {
    stimuli.insert(stimuli.end(), inner.stimuli.begin(), inner.stimuli.end());
  } else if (!inner.stimuli.empty()) {
    stimuli.push_back(fmt::format("{} times ({})", times.full, joined(inner.stimuli)));
  }
  expectations.insert(expectations.end(), inner.expectations.begin(), inner.expectations.end());
  steps.insert(steps.end(), inner.steps.begin(), inner.steps.end());
}

std::string sentence(const std::vector<std::string>& first, const std::vector<std::string>& clauses,
                     const Rounds& rounds, const std::string& over) {
  const std::string repeated = repetition(rounds, over);
  if (repeated.empty() || clauses.empty()) {
    std::vector<std::string> all = first;
    all.insert(all.end(), clauses.begin(), clauses.end());
    return all.empty() ? std::string() : capitalised(joined(all)) + ".";
  }
  if (!first.empty())
    return fmt::format("{}. Then, {}: {}.", capitalised(joined(first)), repeated, joined(clauses));
  if (over.empty()) return fmt::format("{}. All of it {}.", capitalised(joined(clauses)), repeated);
  return fmt::format("{}: {}.", capitalised(repeated), joined(clauses));
}

void describe(TestCase& test_case, const Words& first, const Words& words, const Rounds& rounds,
              const std::string& over) {
  test_case.stimulus = sentence(first.stimuli, words.stimuli, rounds, over);
  test_case.expected = sentence(first.expectations, words.expectations, {}, {});
  const std::size_t count = first.steps.size() + words.steps.size();
  for (const Words* const part : {&first, &words}) {
    for (const std::string& step : part->steps) {
      test_case.steps.push_back(fmt::format("{} of {}: {}", test_case.steps.size() + 1, count, step));
    }
  }
}

}  // namespace fieldproof::conformance::chart
