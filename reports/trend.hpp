// Whether values that came one after another drift: the test of Mann and Kendall, and the slope of Theil and
// Sen. Both know order only, so one wild value does not make a drift, nor hide one.
//
// Contract: `probability` is that of so strong a trend or a stronger one, in either direction, by chance:
// exact where no two values are equal and there are few, else by the normal approximation with ties and
// continuity allowed for. Fewer than kFewestForTrend values are never tested.
#pragma once

#include <cstddef>
#include <span>

namespace fieldproof::reports {

inline constexpr std::size_t kFewestForTrend = 5;

struct Trend {
  std::size_t values = 0;
  double probability = 1;
  double slope = 0;  // from one value to the next; the median over all pairs

  bool is_tested() const { return values >= kFewestForTrend; }
};

// All values are finite.
Trend trend_of(std::span<const double> values);

}  // namespace fieldproof::reports
