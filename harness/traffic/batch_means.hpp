#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

// A mean of values that depend on each other, and how far it may be off.
namespace fieldproof::traffic {

// The standard error is that of the means of successive batches of `batch` values, which is 1 or more.
class BatchMeans {
 public:
  explicit BatchMeans(std::uint64_t batch) : batch_(batch) {}
  void add(double value) {
    sum_ += value;
    ++count_;
    in_batch_ += value;
    if (count_ % batch_ != 0) return;
    means_.push_back(in_batch_ / static_cast<double>(batch_));
    in_batch_ = 0;
  }
  std::uint64_t count() const { return count_; }
  std::size_t batches() const { return means_.size(); }
  const std::vector<double>& means() const { return means_; }
  double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0; }
  double standard_error() const {
    if (means_.size() < 2) return 0;
    const auto n = static_cast<double>(means_.size());
    double mean = 0;
    for (const double one : means_) mean += one / n;
    double squares = 0;
    for (const double one : means_) squares += (one - mean) * (one - mean);
    return std::sqrt(squares / (n - 1) / n);
  }
  // Do the values grow with the simulation? The last third of it has twice the mean of the first one, which
  // chance does not make of so many.
  bool grows() const {
    constexpr std::size_t kFewMeans = 9;
    constexpr std::uint64_t kFewValues = 300;
    if (means_.size() < kFewMeans || count_ < kFewValues) return false;
    const auto third = static_cast<std::ptrdiff_t>(means_.size() / 3);
    const double first = std::accumulate(means_.begin(), means_.begin() + third, 0.0);
    const double last = std::accumulate(means_.end() - third, means_.end(), 0.0);
    return last > 2 * first;
  }

 private:
  std::uint64_t batch_;
  std::uint64_t count_ = 0;
  double sum_ = 0;
  double in_batch_ = 0;
  std::vector<double> means_;
};

}  // namespace fieldproof::traffic
