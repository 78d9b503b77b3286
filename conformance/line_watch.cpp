#include "conformance/line_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::conformance {
namespace {

constexpr kernel::Duration kWindow = 10 * kernel::kMillisecond;
// Of an implementation that counts in whole nanoseconds, or adds bits that were rounded one by one.
constexpr kernel::Duration kRounding = 1 * kernel::kNanosecond;

}  // namespace

LineWatch::LineWatch(kernel::Duration shortest_transmission,
                     std::optional<kernel::Duration> longest_transmission) {
  rules_.rounding = kRounding;
  rules_.longest_drive = longest_transmission;
  rules_.window = kWindow;
  rules_.most_transmissions = static_cast<std::size_t>(kWindow / shortest_transmission) + 1;
}

std::vector<std::string> observations_of_the_watch() {
  std::vector<std::string> names;
  for (const segment::ViolationKind kind : segment::kViolationKinds)
    names.emplace_back(segment::text_of(kind));
  return names;
}

segment::LineMonitor& LineWatch::add(const std::string& line, trace::Trace& trace, trace::Channel place) {
  return places_.emplace_back(Place{line, segment::LineMonitor(rules_, trace, place)}).monitor;
}

bool LineWatch::has_seen() const {
  return std::ranges::any_of(places_, [](const Place& place) { return place.monitor.has_seen(); });
}

void LineWatch::judge(CaseJudge& judge) const {
  for (const Place& place : places_) {
    if (place.monitor.count() == 0) continue;
    const segment::Violation& first = place.monitor.violations().front();
    if (first.kind == segment::ViolationKind::too_many) {
      judge.fail("station_babbles",
                 {{fmt::format("on the line to {}, at most {} transmissions in {}", place.line,
                               rules_.most_transmissions, kernel::describe(rules_.window))},
                  fmt::format("one more in {}", kernel::describe(first.measured)),
                  first.time});
    }
    if (first.kind == segment::ViolationKind::long_drive) {
      judge.fail("driver_held", {{fmt::format("on the line to {}, the driver is off after {} at most",
                                              place.line, kernel::describe(*rules_.longest_drive))},
                                 fmt::format("on for {}", kernel::describe(first.measured)),
                                 first.time});
    }
    judge.fail("transmissions_overlap",
               {{fmt::format("on the line to {}, each transmission begins when the one before has ended",
                             place.line)},
                fmt::format("{} that begin before; the first {} before", place.monitor.count(),
                            kernel::describe(first.measured)),
                first.time});
  }
}

}  // namespace fieldproof::conformance
