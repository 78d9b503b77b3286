#include "emc/threshold_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fieldproof::emc {
namespace {

constexpr double kRung = 2;
constexpr double kCloseEnough = 1.05;  // ratio of two voltages

// The highest voltage of an A below all that is worse.
void settle_a(Thresholds& found) {
  const auto& from_b = found.seen_from[static_cast<std::size_t>(Criterion::b)];
  found.a_up_to_volts = found.certain_volts;
  for (const auto& [volts, worst] : found.probes) {
    if (worst == Criterion::a && (!from_b || volts < *from_b))
      found.a_up_to_volts = std::max(found.a_up_to_volts, volts);
  }
}

class ThresholdSearch {
 public:
  ThresholdSearch(double from, double top, const Probe& probe) : probe_(probe) {
    found_.top_volts = top;
    found_.certain_volts = std::min(std::max(0.0, std::ceil(from) - 1), top);
    climb();
    for (const Criterion criterion : {Criterion::b, Criterion::c, Criterion::d}) narrow(criterion);
    settle_a(found_);
  }

  const Thresholds& found() const { return found_; }

 private:
  void climb() {
    rungs_.push_back(found_.certain_volts);
    while (found_.is_complete && rungs_.back() < found_.top_volts) {
      const double next = std::min(found_.top_volts, std::max(1.0, std::round(rungs_.back() * kRung)));
      at(next);
      rungs_.push_back(next);
    }
  }

  void narrow(Criterion criterion) {
    const auto shows = [this, criterion](double volts) {
      const auto known = found_.probes.find(volts);
      return known != found_.probes.end() && known->second >= criterion;
    };
    const auto first = std::ranges::find_if(rungs_, shows);
    if (first == rungs_.end() || first == rungs_.begin()) return;
    double low = *std::prev(first);
    double high = *first;
    while (found_.is_complete && high > std::max(low, 1.0) * kCloseEnough && high - low > 1) {
      const double middle = std::clamp(std::round(std::sqrt(std::max(low, 1.0) * high)), low + 1, high - 1);
      at(middle);
      (shows(middle) ? high : low) = middle;
    }
    found_.seen_from[static_cast<std::size_t>(criterion)] = high;
  }

  void at(double volts) {
    if (!found_.is_complete || found_.probes.contains(volts)) return;
    const auto worst = found_.probes.size() < kMostProbes ? probe_(volts) : std::nullopt;
    found_.is_complete = worst.has_value();
    if (worst) found_.probes.emplace(volts, *worst);
  }

  const Probe& probe_;
  Thresholds found_;
  std::vector<double> rungs_;
};

}  // namespace

Thresholds find_thresholds(double from, double top, const Probe& probe) {
  return ThresholdSearch(from, top, probe).found();
}

void take(Thresholds& found, double volts, Criterion worst) {
  for (std::size_t n = static_cast<std::size_t>(Criterion::b); n <= static_cast<std::size_t>(worst); ++n)
    found.seen_from.at(n) = std::min(found.seen_from.at(n).value_or(volts), volts);
  settle_a(found);
}

std::string text_of(const Thresholds& thresholds) {
  if (!thresholds.is_complete) return "the search did not end";
  std::string text = fmt::format("A up to {:.0f} V", thresholds.a_up_to_volts);
  std::string not_seen;
  for (const Criterion criterion : {Criterion::b, Criterion::c, Criterion::d}) {
    const auto& from = thresholds.seen_from[static_cast<std::size_t>(criterion)];
    if (from) {
      // One that is worse at the same place says all: this one was never the worst.
      const bool is_worst_there =
          criterion == Criterion::d || thresholds.seen_from[static_cast<std::size_t>(criterion) + 1] != from;
      if (is_worst_there)
        text += fmt::format(", {} {} {:.0f} V", name(criterion),
                            criterion == Criterion::b ? "from" : "seen from", *from);
    } else {
      not_seen += fmt::format("{}{}", not_seen.empty() ? "" : " and ", name(criterion));
    }
  }
  if (!not_seen.empty()) text += fmt::format(", {} not seen up to {:.0f} V", not_seen, thresholds.top_volts);
  return text;
}

}  // namespace fieldproof::emc
