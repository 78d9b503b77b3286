#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "emc/coupling.hpp"
#include "emc/framing.hpp"
#include "emc/generator.hpp"
#include "emc/sampled_impact.hpp"
#include "emc/wrong_spans.hpp"
#include "harness/fault/channel.hpp"
#include "harness/kernel/time.hpp"
#include "harness/line/sampling.hpp"
#include "harness/trace/trace.hpp"

// Bursts at one receiver: what it hears instead of a transmission that pulses hit.
//
// A transmission without a pulse costs one look at the schedule. Else the wrong times of its pulses are laid
// over its levels, and the receiver gets one of three things:
//   - the transmission itself, when nothing of them can be seen at a sampling instant or as an edge;
//   - the transmission with bits flipped, when only sampled bits are wrong at their sampling instants;
//   - the transmission at 64 levels per bit with the wrong times in it: then the receiver itself finds edges
//     and samples where it does.
// The third is the model; the first two are short cuts for a declared receiver and give what that receiver
// would make of the third (see sampled_impact.hpp).
//
// Limits: what happens between transmissions is not heard (a channel is only asked about transmissions), so a
// glitch in front of the first level of one cannot shift its grid. Levels that are finer than bits always
// take the third way.
namespace fieldproof::emc {

struct BurstReceiver {
  std::int64_t bit_rate = 0;
  // Null: nothing is known, each hit transmission is rewritten.
  std::shared_ptr<const Framing> framing;
  line::Sampling sampling;
  bool validates_start = true;
  // Each transmission begins and ends with whole units, as the stations of this project drive them. When this
  // is not said, one that follows another closely is rewritten: it may go on with a unit of that one.
  bool has_whole_units = false;
};

struct BurstStatistics {
  std::uint64_t transmissions = 0;
  std::uint64_t hit_transmissions = 0;        // during which the output was wrong for some time
  std::uint64_t changed_transmissions = 0;    // of these: given on otherwise than they were sent
  std::uint64_t rewritten_transmissions = 0;  // of these: at the fine rate
  std::uint64_t pulses = 0;                   // that made the output wrong during a transmission
  std::uint64_t wrong_levels = 0;             // sent levels during which the output was wrong for some time
  std::uint64_t flipped_bits = 0;             // sampled wrongly, without those of rewritten transmissions

  BurstStatistics& operator+=(const BurstStatistics& other);
};

class BurstChannel final : public fault::Channel {
 public:
  // The effect of a pulse is the same for all pulses of a run. Pulses that changed a transmission become
  // faults "burst pulse" of the trace at `place`.
  BurstChannel(BurstSchedule schedule, WrongOutput wrong, BurstReceiver receiver, trace::Trace& trace,
               trace::Channel place);

  bool pass(const line::Waveform& sent, line::Waveforms& arrivals) override;

  const BurstStatistics& statistics() const { return statistics_; }
  BurstSchedule& schedule() { return schedule_; }
  const BurstSchedule& schedule() const { return schedule_; }

  // Levels per bit of a rewritten transmission; one that is finer itself gets at least as many. A multiple of
  // 16: the instants at which receivers sample are borders of ticks, so the nearest tick keeps not only the
  // mean length of a wrong time but also the chance that it reaches over two samples of a majority.
  static constexpr std::int64_t kTicksPerBit = 64;

 private:
  kernel::Time latest_end(const line::Waveform& sent);
  bool corrupt(const line::Waveform& sent, kernel::Time last_pulse, line::Waveforms& arrivals);
  std::int64_t ticks_for(std::int64_t rate) const;
  kernel::Time last_end() const;
  bool is_far_behind_last(const line::Waveform& sent) const;
  bool is_in_step(const line::Waveform& sent) const;
  void count(const std::vector<Span>& heard);
  template <typename Use>
  void each_pulse_into(const std::vector<Span>& spans, Use&& use) const;
  void flip(const line::Waveform& sent, line::Waveforms& arrivals);
  void rewrite(const line::Waveform& sent, const std::vector<Span>& heard, line::Waveforms& arrivals);
  void tell(const std::vector<Span>& changed);

  BurstSchedule schedule_;
  WrongOutput wrong_;
  Interval reach_;  // of a pulse
  BurstReceiver receiver_;
  trace::Trace& trace_;
  trace::Channel place_;
  BurstStatistics statistics_;
  kernel::Duration longest_unit_{};

  std::int64_t known_rate_ = 0;
  kernel::Duration longest_level_{};  // at that rate

  // The transmission before; its end is computed when the bound does not decide.
  kernel::Time last_latest_end_{};
  kernel::Time last_start_{};
  std::size_t last_levels_ = 0;
  std::int64_t last_rate_ = 0;   // 0: there was none
  bool is_out_of_step_ = false;  // perhaps, since a transmission was rewritten

  // Of the transmission that passes.
  struct Pulse {
    kernel::Time time;
    Span reach;
  };
  std::vector<Pulse> pulses_;
  WrongSpans spans_;
  SampledImpact impact_;
  std::vector<Span> flipped_;
};

}  // namespace fieldproof::emc
