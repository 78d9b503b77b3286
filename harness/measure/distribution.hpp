#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "harness/kernel/time.hpp"

// How the values of one quantity are distributed: extremes, mean, standard deviation, quantiles and a
// histogram, of any number of whole numbers.
//
// Contract: count, min and max are exact; mean and standard deviation (of the population: the sum of squares
// is divided by the count) are sums of doubles in the order in which values came. Quantiles are by nearest
// rank and exact up to `most_exact` values. Above that the values go into buckets of a log-linear histogram,
// and a quantile between the extremes is the middle of its bucket, within kRelativeError of the exact one;
// that costs at most 2048 buckets for each power of two that the values span. What is asked of an empty
// distribution is 0.
namespace fieldproof::measure {

class Distribution {
 public:
  static constexpr std::size_t kMostExact = 65'536;
  static constexpr double kRelativeError = 1.0 / 2048;

  explicit Distribution(std::size_t most_exact = kMostExact) : most_exact_(most_exact) {}

  void add(std::int64_t value);
  void add(kernel::Duration duration) { add(duration.count()); }
  void add(const Distribution& other);

  bool is_empty() const { return count_ == 0; }
  std::uint64_t count() const { return count_; }
  std::int64_t min() const { return min_; }
  std::int64_t max() const { return max_; }
  double mean() const { return mean_; }
  double standard_deviation() const;

  // The smallest value that at least the part `part` (0 to 1) of all values does not exceed.
  std::int64_t quantile(double part) const;
  bool has_exact_quantiles() const { return buckets_.empty(); }

  struct Bin {
    std::int64_t low = 0;
    std::int64_t high = 0;  // the first value above the bin; of the last bin the largest value
    std::uint64_t count = 0;
  };
  // Equal bins from the least to the largest value, at most `bins` of them; one when all values are equal.
  std::vector<Bin> histogram(std::size_t bins) const;

 private:
  void pour(std::int64_t value, std::uint64_t count);
  void pour_values();

  std::size_t most_exact_;
  std::vector<std::int64_t> values_;               // until there are too many
  std::map<std::int64_t, std::uint64_t> buckets_;  // from then on; by key, which grows with the value
  std::uint64_t count_ = 0;
  std::int64_t min_ = 0;
  std::int64_t max_ = 0;
  double mean_ = 0;
  double squares_ = 0;  // sum of squared distances from the mean
};

}  // namespace fieldproof::measure
