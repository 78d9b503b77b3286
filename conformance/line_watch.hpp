#pragma once

#include <deque>
#include <string>

#include "conformance/judging.hpp"
#include "harness/kernel/time.hpp"
#include "harness/segment/link.hpp"
#include "harness/segment/monitor.hpp"
#include "harness/trace/trace.hpp"

// The monitors of the lines that are driven in a bench. They are always on: whatever a case looks at, a
// station that drives over itself or babbles fails it.
namespace fieldproof::conformance {

class LineWatch {
 public:
  // `shortest_transmission` is that of the protocol: more of them than fit a window are babble, even where
  // each is too short to overlap the next.
  explicit LineWatch(kernel::Duration shortest_transmission);

  // What is driven into the link from now on. The link must outlive the segment's last run.
  void watch(segment::Link& link, trace::Trace& trace);

  // Fails the case at the first violation, with `transmissions_overlap` or `station_babbles`. For the end of
  // a procedure.
  void judge(CaseJudge& judge) const;

 private:
  struct Place {
    std::string line;
    segment::LineMonitor monitor;
  };

  segment::MonitorRules rules_;
  std::deque<Place> places_;  // a link keeps the address of its tap
};

}  // namespace fieldproof::conformance
