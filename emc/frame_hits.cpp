#include "emc/frame_hits.hpp"

#include <algorithm>
#include <cmath>

#include "harness/kernel/check.hpp"

namespace fieldproof::emc {
namespace {

bool is_wrong(const std::vector<Interval>& wrong, kernel::Duration time) {
  return std::ranges::any_of(wrong,
                             [time](const Interval& one) { return one.from <= time && time < one.to; });
}

// The level is sampled wrongly, its middle sample at `time`.
bool is_sampled_wrong(const std::vector<Interval>& wrong, line::Sampling sampling, kernel::Duration time,
                      kernel::Duration sixteenth) {
  if (sampling.kind == line::Sampling::Kind::mid_bit) return is_wrong(wrong, time);
  return int{is_wrong(wrong, time - sixteenth)} + int{is_wrong(wrong, time)} +
             int{is_wrong(wrong, time + sixteenth)} >=
         2;
}

}  // namespace

double chance_of_hit(const WrongOutput& wrong, line::Sampling sampling, std::int64_t bit_rate) {
  constexpr int kPhases = 256;
  if (wrong.empty()) return 0;
  const kernel::Duration bit = kernel::levels_duration(1, bit_rate);
  const kernel::Duration sixteenth = kernel::levels_duration(1, 16 * bit_rate);
  const Interval hull = wrong.hull();
  double missed = 0;
  for (int phase = 0; phase < kPhases; ++phase) {
    double none = 1;
    const kernel::Duration first = hull.from - bit + bit * (2 * phase + 1) / (2 * kPhases);
    for (kernel::Duration time = first; time < hull.to + sixteenth; time += bit) {
      int wrong_levels = 0;  // of the two that may be driven
      for (const auto& of_level : wrong.of_level)
        wrong_levels += is_sampled_wrong(of_level, sampling, time, sixteenth) ? 1 : 0;
      none *= 1 - wrong_levels / 2.0;
    }
    missed += none;
  }
  return 1 - missed / kPhases;
}

FrameHits::FrameHits(unsigned levels, std::int64_t bit_rate, Repetition repetition) {
  FIELDPROOF_CHECK(levels > 0 && bit_rate > 0, "a frame has levels");
  constexpr double kSteps = 64;  // of a pitch
  BurstSettings settings;
  settings.repetition = repetition;
  settings.tolerances = Tolerances::none;
  const BurstTiming timing = BurstSchedule(settings, kernel::Random(0)).timing();
  const auto pitch = static_cast<double>(timing.pitch.count());
  const double frame = 1e12 * levels / static_cast<double>(bit_rate) / pitch;  // in pitches
  const auto pulses = static_cast<double>(timing.pulses);
  const double period = static_cast<double>(timing.period.count()) / pitch;
  // The first pulse of the burst comes so much after the frame begins; the frames that meet one burst only.
  const double longest = std::min(frame, period);
  for (double at = -pulses + 0.5 / kSteps; at < longest; at += 1 / kSteps) {
    const double first = std::max(0.0, std::ceil(-at));
    const double last = std::min(pulses - 1, std::ceil(longest - at) - 1);
    if (last < first) continue;
    const auto count = static_cast<std::size_t>(last - first + 1);
    if (shares_.size() < count) shares_.resize(count);
    shares_[count - 1] += 1 / kSteps / period;
  }
}

double FrameHits::corrupted(double strength) const {
  double sum = 0;
  for (std::size_t n = 0; n < shares_.size(); ++n)
    sum -= shares_[n] * std::expm1(-strength * static_cast<double>(n + 1));
  return std::min(sum, 1.0);
}

}  // namespace fieldproof::emc
