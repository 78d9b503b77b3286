#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "conformance/judging.hpp"
#include "harness/kernel/time.hpp"
#include "harness/segment/monitor.hpp"
#include "harness/trace/trace.hpp"

// The monitors of the lines that are driven in a bench. They are always on: whatever a case looks at, a
// station that drives over itself or babbles fails it.
namespace fieldproof::conformance {

// What it observes, as a plan of faults may name it.
std::vector<std::string> observations_of_the_watch();

class LineWatch {
 public:
  // `shortest_transmission` is that of the protocol: more of them than fit a window are babble, even where
  // each is too short to overlap the next.
  // Who drives longer than `longest_transmission` without a pause holds its driver on, whatever it drives;
  // absent: a line of its own may be driven for ever.
  explicit LineWatch(kernel::Duration shortest_transmission,
                     std::optional<kernel::Duration> longest_transmission = {});

  // What is driven into the line from now on: a link, or a station's place on a bus. It must outlive the
  // segment's last run.
  template <typename Line>
  void watch(Line& line, trace::Trace& trace) {
    line.tap_driven(add(line.name(), trace, line.trace_channel()));
  }

  // Fails the case at the first violation, with `transmissions_overlap`, `station_babbles` or `driver_held`.
  // For the end of a procedure.
  void judge(CaseJudge& judge) const;
  // Whether anything was driven at all.
  bool has_seen() const;

 private:
  struct Place {
    std::string line;
    segment::LineMonitor monitor;
  };

  segment::LineMonitor& add(const std::string& line, trace::Trace& trace, trace::Channel place);

  segment::MonitorRules rules_;
  std::deque<Place> places_;  // a line keeps the address of its tap
};

}  // namespace fieldproof::conformance
