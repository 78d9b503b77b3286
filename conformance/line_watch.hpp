#pragma once

#include <deque>
#include <string>

#include "conformance/judging.hpp"
#include "harness/segment/link.hpp"
#include "harness/segment/monitor.hpp"
#include "harness/trace/trace.hpp"

// The monitors of the lines that are driven in a bench. They are always on: whatever a case looks at, a
// station that drives over itself fails it.
namespace fieldproof::conformance {

class LineWatch {
 public:
  // What is driven into the link from now on. The link must outlive the segment's last run.
  void watch(segment::Link& link, trace::Trace& trace);

  // Fails the case with `transmissions_overlap` at the first violation. For the end of a procedure.
  void judge(CaseJudge& judge) const;

 private:
  struct Place {
    std::string line;
    segment::LineMonitor monitor;
  };

  std::deque<Place> places_;  // a link keeps the address of its tap
};

}  // namespace fieldproof::conformance
