#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/measure/phase.hpp"

// When the values of a quantity came: what a distribution forgets. A run is cut into equal windows, and of
// each window and phase the least, the mean and the greatest value are kept.
//
// Contract: however long a run lasts, it has at most as many windows as were asked for, and a window that no
// value fell into costs nothing. Count, least and greatest are exact, the mean is a sum of doubles in the
// order in which values came. The greatest values of all are kept with their exact instants, the earlier of
// equals.
namespace fieldproof::measure {

class TimeCourse {
 public:
  static constexpr std::size_t kMostLongest = 5;

  struct Point {
    kernel::Duration from;  // of its window, since the begin of the run
    Phase phase = Phase::quiet;
    std::uint64_t count = 0;
    std::int64_t min = 0;
    std::int64_t max = 0;
    double mean = 0;
  };
  struct Instant {
    kernel::Duration when;  // since the begin of the run
    Phase phase = Phase::quiet;
    std::int64_t value = 0;
  };

  TimeCourse() = default;
  // Of a run that lasts `length`; there is at least one window.
  TimeCourse(kernel::Duration length, std::size_t most_windows);

  kernel::Duration length() const { return length_; }
  kernel::Duration window() const { return window_; }

  // A value that came at `when`; one from before the run counts to the first window, one from after it to the
  // last.
  void add(kernel::Duration when, Phase phase, std::int64_t value);

  // In the order of time, within a window in that of phases.
  std::vector<Point> points() const;
  // The greatest first.
  const std::vector<Instant>& longest() const { return longest_; }

 private:
  kernel::Duration length_{1};
  kernel::Duration window_{1};
  std::map<std::pair<std::int64_t, Phase>, Point> points_;  // by the number of the window
  std::vector<Instant> longest_;
};

// A time in which a disturbance was on the line, or several that are too near to each other to be told apart.
struct Band {
  kernel::Duration from;  // since the begin of the run
  kernel::Duration to;
  std::uint64_t disturbances = 1;
};

struct Span {
  kernel::Time from;
  kernel::Time to;
};
// The first disturbance that ends after an instant; nothing: none does. Whoever disturbs knows.
using NextDisturbance = std::function<std::optional<Span>(kernel::Time after)>;

// The disturbances of a run that begins at `begin`, cut at its ends. Those that are nearer to each other than
// `apart` are one band, so there are at most length / apart + 1 of them.
std::vector<Band> bands_between(const NextDisturbance& next, kernel::Time begin, kernel::Duration length,
                                kernel::Duration apart);

}  // namespace fieldproof::measure
