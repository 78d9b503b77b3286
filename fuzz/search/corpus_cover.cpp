#include "fuzz/search/corpus_cover.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace fieldproof::fuzz {

std::vector<std::size_t> smallest_cover(std::span<const CoveringInput> inputs) {
  std::vector<std::size_t> order(inputs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t left, std::size_t right) {
    const auto& one = inputs[left].octets;
    const auto& other = inputs[right].octets;
    return one.size() != other.size() ? one.size() < other.size() : one < other;
  });
  std::map<std::uint64_t, std::size_t> times;  // that each feature is passed by those that were taken
  std::vector<std::size_t> taken;
  for (const std::size_t place : order) {
    const auto& features = inputs[place].features;
    if (std::ranges::all_of(features, [&](std::uint64_t one) { return times.contains(one); })) continue;
    taken.push_back(place);
    for (const std::uint64_t feature : features) ++times[feature];
  }
  // A longer one that came later may pass all that a shorter one had been taken for.
  std::vector<std::size_t> needed;
  for (const std::size_t place : taken) {
    const auto& features = inputs[place].features;
    const bool is_needed =
        std::ranges::any_of(features, [&](std::uint64_t one) { return times.at(one) == 1; });
    if (is_needed) needed.push_back(place);
    if (!is_needed) {
      for (const std::uint64_t feature : features) --times.at(feature);
    }
  }
  std::ranges::sort(needed);
  return needed;
}

}  // namespace fieldproof::fuzz
