#include "harness/measure/edge_skew.hpp"

#include <cmath>
#include <utility>

namespace fieldproof::measure {
namespace {

using Edge = TwoChannelRecorder::Edge;

class Matching {
 public:
  Matching(const TwoChannelRecorder& recorder, const PhaseDuring& phase_during)
      : generator_(recorder.generator()), phase_during_(phase_during) {}

  // `next` is null for the last edge of the record.
  void on_edge(const Edge& edge, const Edge* next) {
    const kernel::Time input = generator_.edge(edge.number);
    const Phase phase = measure::phase_during(phase_during_, input, edge.when);
    if (edge.number % 2 == 0) {
      if (generator_.is_train_end(edge.number)) return;
      skew_.fall_delays.add(phase, edge.when - input);
      ++shown_pauses_;
      return;
    }
    skew_.rise_delays.add(phase, edge.when - input);
    ++shown_pulses_;
    if (next != nullptr) on_pulse(edge, *next);
  }

  EdgeSkew finish(std::uint64_t foreign_words) {
    skew_.pulses = generator_.pulse_count();
    skew_.lost_pulses = skew_.pulses - shown_pulses_;
    skew_.pauses = generator_.pause_count();
    skew_.lost_pauses = skew_.pauses - shown_pauses_;
    skew_.foreign_words = foreign_words;
    return std::move(skew_);
  }

 private:
  void on_pulse(const Edge& rise, const Edge& next) {
    const kernel::Time begin = generator_.edge(rise.number);
    const kernel::Duration width = next.when - rise.when;
    const kernel::Duration error = width - (generator_.edge(rise.number + 1) - begin);
    const Phase phase = measure::phase_during(phase_during_, begin, next.when);
    skew_.widths.add(phase, width);
    skew_.width_errors.add(phase, error);
    const double part =
        static_cast<double>(error.count()) / static_cast<double>(generator_.wave().period().count());
    skew_.duty_errors_ppm.add(phase, std::int64_t{std::llround(1e6 * part)});
  }

  const SignalGenerator& generator_;
  const PhaseDuring& phase_during_;
  EdgeSkew skew_;
  std::uint64_t shown_pulses_ = 0;
  std::uint64_t shown_pauses_ = 0;
};

}  // namespace

EdgeSkew edge_skew(const TwoChannelRecorder& recorder, const PhaseDuring& phase_during) {
  Matching matching(recorder, phase_during);
  const auto& edges = recorder.output_edges();
  for (std::size_t n = 0; n < edges.size(); ++n) {
    matching.on_edge(edges[n], n + 1 < edges.size() ? &edges[n + 1] : nullptr);
  }
  return matching.finish(recorder.foreign_words().size());
}

}  // namespace fieldproof::measure
