#include "conformance/line_watch.hpp"

#include <fmt/format.h>

namespace fieldproof::conformance {

void LineWatch::watch(segment::Link& link, trace::Trace& trace) {
  places_.push_back({link.name(), segment::LineMonitor({}, trace, link.trace_channel())});
  link.tap_driven(places_.back().monitor);
}

void LineWatch::judge(CaseJudge& judge) const {
  for (const Place& place : places_) {
    if (place.monitor.count() == 0) continue;
    const segment::Violation& first = place.monitor.violations().front();
    judge.fail("transmissions_overlap",
               {{fmt::format("on the line to {}, each transmission begins when the one before has ended",
                             place.line)},
                fmt::format("{} times not; the first time {} too early", place.monitor.count(),
                            kernel::describe(first.measured)),
                first.time});
  }
}

}  // namespace fieldproof::conformance
