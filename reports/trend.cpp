#include "reports/trend.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace fieldproof::reports {
namespace {

constexpr std::size_t kMostForExact = 30;

struct Pairs {
  std::int64_t rising_less_falling = 0;
  bool has_ties = false;
};

Pairs pairs_of(std::span<const double> values) {
  Pairs pairs;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = i + 1; j < values.size(); ++j) {
      pairs.rising_less_falling += values[j] > values[i] ? 1 : values[j] < values[i] ? -1 : 0;
      pairs.has_ties = pairs.has_ties || values[j] == values[i];
    }
  }
  return pairs;
}

// How likely each number of falling pairs is when every order of n values is as likely as any other.
std::vector<double> chances_of_falling_pairs(std::size_t n) {
  std::vector<double> chances = {1};
  for (std::size_t size = 2; size <= n; ++size) {
    std::vector<double> next(chances.size() + size - 1, 0);
    for (std::size_t pairs = 0; pairs < chances.size(); ++pairs) {
      for (std::size_t more = 0; more < size; ++more)
        next[pairs + more] += chances[pairs] / static_cast<double>(size);
    }
    chances = std::move(next);
  }
  return chances;
}

double exact_probability(std::size_t n, std::int64_t sum) {
  const std::vector<double> chances = chances_of_falling_pairs(n);
  const auto pairs = static_cast<std::int64_t>(chances.size() - 1);
  double probability = 0;
  for (std::int64_t falling = 0; falling <= pairs; ++falling) {
    if (std::abs(pairs - 2 * falling) >= std::abs(sum))
      probability += chances[static_cast<std::size_t>(falling)];
  }
  return std::min(probability, 1.0);
}

double normal_probability(std::span<const double> values, std::int64_t sum) {
  const auto weight = [](double n) { return n * (n - 1) * (2 * n + 5); };
  std::map<double, std::size_t> equal;
  for (const double value : values) ++equal[value];
  double variance = weight(static_cast<double>(values.size()));
  for (const auto& [value, count] : equal) variance -= weight(static_cast<double>(count));
  variance /= 18;
  if (variance <= 0 || sum == 0) return 1;
  const double deviations = (std::abs(static_cast<double>(sum)) - 1) / std::sqrt(variance);
  return std::erfc(deviations / std::sqrt(2.0));
}

double median_slope(std::span<const double> values) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = i + 1; j < values.size(); ++j)
      slopes.push_back((values[j] - values[i]) / static_cast<double>(j - i));
  }
  const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
  std::ranges::nth_element(slopes, middle);
  if (slopes.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(slopes.begin(), middle)) / 2;
}

}  // namespace

Trend trend_of(std::span<const double> values) {
  Trend trend;
  trend.values = values.size();
  if (!trend.is_tested()) return trend;
  const Pairs pairs = pairs_of(values);
  trend.probability = !pairs.has_ties && values.size() <= kMostForExact
                          ? exact_probability(values.size(), pairs.rising_less_falling)
                          : normal_probability(values, pairs.rising_less_falling);
  trend.slope = median_slope(values);
  return trend;
}

}  // namespace fieldproof::reports
