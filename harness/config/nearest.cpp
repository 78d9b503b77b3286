#include "harness/config/nearest.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace fieldproof::config {

namespace {

constexpr std::size_t kLongest = 256;

template <typename Word>
std::vector<std::string_view> nearest_of(std::string_view word, std::span<const Word> candidates,
                                         std::size_t max) {
  std::vector<std::pair<std::size_t, std::size_t>> ranked;  // distance, position
  ranked.reserve(candidates.size());
  for (const auto& candidate : candidates) {
    ranked.emplace_back(edit_distance(word, candidate), ranked.size());
  }
  std::sort(ranked.begin(), ranked.end());
  if (ranked.size() > max) ranked.resize(max);
  std::vector<std::string_view> found;
  for (const auto& [distance, position] : ranked) found.push_back(candidates[position]);
  return found;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  a = a.substr(0, kLongest);
  b = b.substr(0, kLongest);
  // Rows of the distance table: row[j] is the distance of a's first i octets to b's first j.
  using Row = std::array<std::size_t, kLongest + 1>;
  Row row{};
  Row before{};
  Row before_that{};
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_that = before;
    before = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = before[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
      row[j] = std::min({before[j] + 1, row[j - 1] + 1, replaced});
      const bool is_swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swap) row[j] = std::min(row[j], before_that[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::vector<std::string_view> nearest(std::string_view word, std::span<const std::string_view> candidates,
                                      std::size_t max) {
  return nearest_of(word, candidates, max);
}

std::vector<std::string_view> nearest(std::string_view word, std::span<const std::string> candidates,
                                      std::size_t max) {
  return nearest_of(word, candidates, max);
}

std::optional<std::string_view> misspelled(std::string_view word,
                                           std::span<const std::string_view> candidates) {
  const auto found = nearest(word, candidates, 1);
  if (found.empty()) return std::nullopt;
  const std::size_t longer = std::min(kLongest, std::max(word.size(), found.front().size()));
  const std::size_t allowed = std::max<std::size_t>(1, longer / 3);
  if (edit_distance(word, found.front()) > allowed) return std::nullopt;
  return found.front();
}

}  // namespace fieldproof::config
