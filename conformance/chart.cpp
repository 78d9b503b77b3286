#include "conformance/chart.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace fieldproof::conformance::chart {

namespace {

std::string joined(const std::vector<std::string>& clauses) {
  std::vector<std::string> said;
  for (auto clause = clauses.begin(); clause != clauses.end();) {
    const auto next = std::find_if(clause, clauses.end(), [&](const auto& each) { return each != *clause; });
    const auto count = next - clause;
    said.push_back(count > 1 ? fmt::format("{}, {} times", *clause, count) : *clause);
    clause = next;
  }
  return said.empty() ? std::string() : fmt::format("{}.", fmt::join(said, "; "));
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

}  // namespace

std::string sentence(const std::vector<std::string>& clauses, const Rounds& rounds) {
  return sentence({}, clauses, rounds, {});
}

std::string sentence(const std::vector<std::string>& first, const std::vector<std::string>& clauses,
                     const Rounds& rounds, const std::string& over) {
  const std::string repeated = repetition(rounds, over);
  if (repeated.empty() || clauses.empty()) {
    std::vector<std::string> all = first;
    all.insert(all.end(), clauses.begin(), clauses.end());
    return capitalised(joined(all));
  }
  if (!first.empty())
    return fmt::format("{} Then, {}: {}", capitalised(joined(first)), repeated, joined(clauses));
  if (over.empty()) return fmt::format("{} All of it {}.", capitalised(joined(clauses)), repeated);
  return fmt::format("{}: {}", capitalised(repeated), joined(clauses));
}

std::string line_of(std::size_t number, std::size_t count, const std::string& stimulus,
                    const std::string& expected) {
  const char* const joint = stimulus.empty() || expected.empty() ? "" : "; ";
  const char* const label = expected.empty() ? "" : "expected: ";
  return fmt::format("{} of {}: {}{}{}{}", number, count, stimulus, joint, label, expected);
}

}  // namespace fieldproof::conformance::chart
