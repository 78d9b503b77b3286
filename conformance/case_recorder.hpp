#pragma once

#include <memory>
#include <optional>

#include "conformance/test_case.hpp"
#include "harness/trace/dissector.hpp"
#include "harness/trace/recording.hpp"

// Records one run of a case where its setup wants that, for the outcome: what every suite does alike.
namespace fieldproof::conformance {

class CaseRecorder {
 public:
  // The recorder of this trace, for `Trace::set_recorder`. It must outlive the trace's use.
  trace::Recorder& start(const trace::Trace& trace, std::shared_ptr<const trace::Dissector> dissector) {
    dissector_ = std::move(dissector);
    return recorder_.emplace(trace);
  }

  // What was kept, in the outcome; nothing when it was never started.
  void keep(Outcome& outcome) {
    if (!recorder_) return;
    Recording& kept = outcome.recording;
    kept.trace = recorder_->take();
    kept.dissector = std::move(dissector_);
    kept.truncated = kept.trace.is_cut;
  }

 private:
  std::optional<trace::BoundedRecorder> recorder_;
  std::shared_ptr<const trace::Dissector> dissector_;
};

}  // namespace fieldproof::conformance
