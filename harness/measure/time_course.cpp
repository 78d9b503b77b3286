#include "harness/measure/time_course.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {

using kernel::Duration;

TimeCourse::TimeCourse(Duration length, std::size_t most_windows) : length_(length) {
  FIELDPROOF_CHECK(length > Duration::zero() && most_windows > 0, "a run lasts, and has at least one window");
  const auto windows = static_cast<std::int64_t>(most_windows);
  window_ = Duration{length.count() / windows + (length.count() % windows == 0 ? 0 : 1)};
}

void TimeCourse::add(Duration when, Phase phase, std::int64_t value) {
  const std::int64_t last = (length_.count() - 1) / window_.count();
  const std::int64_t number = std::clamp<std::int64_t>(when.count() / window_.count(), 0, last);
  const auto [found, is_new] = points_.try_emplace({number, phase});
  Point& point = found->second;
  if (is_new) point = {number * window_, phase, 0, value, value, 0};
  point.min = std::min(point.min, value);
  point.max = std::max(point.max, value);
  ++point.count;
  point.mean += (static_cast<double>(value) - point.mean) / static_cast<double>(point.count);
  if (longest_.size() == kMostLongest && value <= longest_.back().value) return;
  const auto place =
      std::ranges::upper_bound(longest_, value, std::ranges::greater{}, &TimeCourse::Instant::value);
  longest_.insert(place, {when, phase, value});
  if (longest_.size() > kMostLongest) longest_.pop_back();
}

std::vector<TimeCourse::Point> TimeCourse::points() const {
  std::vector<Point> points;
  points.reserve(points_.size());
  for (const auto& [key, point] : points_) points.push_back(point);
  return points;
}

std::vector<Band> bands_between(const NextDisturbance& next, kernel::Time begin, Duration length,
                                Duration apart) {
  std::vector<Band> bands;
  if (!next) return bands;
  const kernel::Time end = begin + length;
  for (auto span = next(begin); span && span->from < end; span = next(span->to)) {
    FIELDPROOF_CHECK(span->from < span->to, "a disturbance lasts");
    const Duration from = std::max(span->from, begin) - begin;
    const Duration to = std::min(span->to, end) - begin;
    if (!bands.empty() && from - bands.back().to < apart) {
      bands.back().to = std::max(bands.back().to, to);
      ++bands.back().disturbances;
    } else {
      bands.push_back({from, to, 1});
    }
  }
  return bands;
}

}  // namespace fieldproof::measure
