#include "conformance/decoded_lines.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::conformance {

std::string_view supply_text(bool is_on) {
  return is_on ? "the supply returned" : "the supply went";
}

void DecodedLines::add_supply(kernel::Time when, bool is_on) {
  if (when == kernel::kStart) return;
  add(when, fmt::format("{} at {}", supply_text(is_on), kernel::describe(when)));
}

std::vector<std::string> DecodedLines::last() const {
  constexpr std::size_t kMostLines = 12;
  auto sorted = all_;
  std::ranges::stable_sort(sorted, {}, &std::pair<kernel::Time, std::string>::first);
  if (sorted.empty()) return {"nothing was driven by anybody"};
  const std::size_t first = sorted.size() - std::min(sorted.size(), kMostLines);
  std::vector<std::string> lines;
  for (std::size_t n = first; n < sorted.size(); ++n) lines.push_back(std::move(sorted[n].second));
  return lines;
}

}  // namespace fieldproof::conformance
