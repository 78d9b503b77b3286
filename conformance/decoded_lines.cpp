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

std::vector<std::string> DecodedLines::around(kernel::Time time) const {
  constexpr std::size_t kMostLines = 12;
  constexpr std::size_t kMostAfter = 2;
  using Line = std::pair<kernel::Time, std::string>;
  auto sorted = all_;
  std::ranges::stable_sort(sorted, {}, &Line::first);
  if (sorted.empty()) return {"nothing was driven by anybody"};
  const auto after =
      static_cast<std::size_t>(std::ranges::upper_bound(sorted, time, {}, &Line::first) - sorted.begin());
  const std::size_t end = std::min(sorted.size(), after + kMostAfter);
  const std::size_t first = end - std::min(end, kMostLines);
  std::vector<std::string> lines;
  for (std::size_t n = first; n < end; ++n) lines.push_back(std::move(sorted[n].second));
  return lines;
}

}  // namespace fieldproof::conformance
