#include "conformance/chart.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace fieldproof::conformance::chart {

std::string sentence(const std::vector<std::string>& clauses, const Rounds& rounds) {
  std::vector<std::string> said;
  for (auto clause = clauses.begin(); clause != clauses.end();) {
    const auto next = std::find_if(clause, clauses.end(), [&](const auto& each) { return each != *clause; });
    const auto count = next - clause;
    said.push_back(count > 1 ? fmt::format("{}, {} times", *clause, count) : *clause);
    clause = next;
  }
  if (said.empty()) return {};
  std::string text = fmt::format("{}.", fmt::join(said, "; "));
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (rounds.full > 1) text += fmt::format(" All of it {} times.", rounds.full);
  return text;
}

std::string line_of(std::size_t number, std::size_t count, const std::string& stimulus,
                    const std::string& expected) {
  const char* const joint = stimulus.empty() || expected.empty() ? "" : "; ";
  const char* const label = expected.empty() ? "" : "expected: ";
  return fmt::format("{} of {}: {}{}{}{}", number, count, stimulus, joint, label, expected);
}

}  // namespace fieldproof::conformance::chart
