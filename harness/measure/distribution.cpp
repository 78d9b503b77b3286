#include "harness/measure/distribution.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

// A bucket holds the values that agree in their sign and their first kBits + 1 binary digits; values with
// fewer digits have a bucket each. Half of a bucket is then 2^-(kBits + 1) of its least value.
constexpr unsigned kBits = 10;

struct Bucket {
  std::uint64_t least = 0;  // by size
  std::uint64_t width = 1;
};

std::int64_t key_of(std::int64_t value) {
  const bool is_negative = value < 0;
  const std::uint64_t size =
      is_negative ? ~static_cast<std::uint64_t>(value) + 1 : static_cast<std::uint64_t>(value);
  const auto digits = static_cast<unsigned>(std::bit_width(size));
  const unsigned shift = digits > kBits + 1 ? digits - (kBits + 1) : 0;
  const auto key = static_cast<std::int64_t>((std::uint64_t{shift} << kBits) + (size >> shift));
  return is_negative ? -key : key;
}

Bucket bucket_of(std::int64_t key) {
  const auto size = static_cast<std::uint64_t>(key < 0 ? -key : key);
  if (size < std::uint64_t{2} << kBits) return {size, 1};
  const std::uint64_t shift = (size >> kBits) - 1;
  return {(size - (shift << kBits)) << shift, std::uint64_t{1} << shift};
}

std::int64_t middle_of(std::int64_t key) {
  const Bucket bucket = bucket_of(key);
  constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  const auto size = static_cast<std::int64_t>(std::min(kLargest, bucket.least + (bucket.width - 1) / 2));
  return key < 0 ? -size : size;
}

}  // namespace

void Distribution::add(std::int64_t value) {
  min_ = is_empty() ? value : std::min(min_, value);
  max_ = is_empty() ? value : std::max(max_, value);
  ++count_;
  // Welford's recurrence: no difference of two large sums.
  const double distance = static_cast<double>(value) - mean_;
  mean_ += distance / static_cast<double>(count_);
  squares_ += distance * (static_cast<double>(value) - mean_);
  if (!has_exact_quantiles()) return pour(value, 1);
  values_.push_back(value);
  if (values_.size() > most_exact_) pour_values();
}

void Distribution::add(const Distribution& other) {
  if (other.is_empty()) return;
  min_ = is_empty() ? other.min_ : std::min(min_, other.min_);
  max_ = is_empty() ? other.max_ : std::max(max_, other.max_);
  const auto own = static_cast<double>(count_);
  const auto added = static_cast<double>(other.count_);
  const double distance = other.mean_ - mean_;
  mean_ += distance * added / (own + added);
  squares_ += other.squares_ + distance * distance * own * added / (own + added);
  count_ += other.count_;
  values_.insert(values_.end(), other.values_.begin(), other.values_.end());
  if (!has_exact_quantiles() || !other.has_exact_quantiles() || values_.size() > most_exact_) pour_values();
  for (const auto& [key, count] : other.buckets_) pour(middle_of(key), count);
}

void Distribution::pour(std::int64_t value, std::uint64_t count) {
  buckets_[key_of(value)] += count;
}

void Distribution::pour_values() {
  for (const std::int64_t value : values_) pour(value, 1);
  values_.clear();
  values_.shrink_to_fit();
}

double Distribution::standard_deviation() const {
  return is_empty() ? 0.0 : std::sqrt(std::max(0.0, squares_ / static_cast<double>(count_)));
}

std::int64_t Distribution::quantile(double part) const {
  FIELDPROOF_CHECK(part >= 0 && part <= 1, "a quantile is asked for a part of all values");
  if (is_empty()) return 0;
  const double wanted = std::ceil(part * static_cast<double>(count_));
  const auto rank = std::clamp<std::uint64_t>(static_cast<std::uint64_t>(wanted), 1, count_);
  if (has_exact_quantiles()) {
    std::vector<std::int64_t> values = values_;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(values.begin(), at, values.end());
    return *at;
  }
  if (rank == 1) return min_;
  if (rank == count_) return max_;
  std::uint64_t passed = 0;
  for (const auto& [key, count] : buckets_) {
    passed += count;
    if (passed >= rank) return std::clamp(middle_of(key), min_, max_);
  }
  return max_;
}

std::vector<Distribution::Bin> Distribution::histogram(std::size_t bins) const {
  FIELDPROOF_CHECK(bins > 0, "a histogram has at least one bin");
  if (is_empty()) return {};
  const auto span = static_cast<std::uint64_t>(max_) - static_cast<std::uint64_t>(min_);
  const std::uint64_t width = span / bins + 1;
  std::vector<Bin> all(static_cast<std::size_t>(span / width) + 1);
  for (std::size_t n = 0; n < all.size(); ++n) {
    all[n].low = static_cast<std::int64_t>(static_cast<std::uint64_t>(min_) + n * width);
    all[n].high = n + 1 == all.size()
                      ? max_
                      : static_cast<std::int64_t>(static_cast<std::uint64_t>(all[n].low) + width);
  }
  const auto put = [&](std::int64_t value, std::uint64_t count) {
    const auto offset =
        static_cast<std::uint64_t>(std::clamp(value, min_, max_)) - static_cast<std::uint64_t>(min_);
    all[static_cast<std::size_t>(offset / width)].count += count;
  };
  for (const std::int64_t value : values_) put(value, 1);
  for (const auto& [key, count] : buckets_) put(middle_of(key), count);
  return all;
}

}  // namespace fieldproof::measure
