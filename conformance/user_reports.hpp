#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

// What the implementation has given its user, in the words of a finding.
namespace fieldproof::conformance {

// The last few of `reports`: "nothing", "A; B", "9, at last A; B; C; D".
template <typename Reports, typename Text>
std::string reports_text(const Reports& reports, Text text) {
  constexpr std::size_t kMostShown = 4;
  if (reports.empty()) return "nothing";
  const std::size_t first = reports.size() - std::min(reports.size(), kMostShown);
  std::string all = first == 0 ? "" : std::to_string(reports.size()) + ", at last ";
  for (std::size_t at = first; at < reports.size(); ++at)
    all += (at == first ? "" : "; ") + std::string(text(reports[at]));
  return all;
}

}  // namespace fieldproof::conformance
