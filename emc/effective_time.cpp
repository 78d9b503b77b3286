#include "emc/effective_time.hpp"

#include <algorithm>
#include <vector>

namespace fieldproof::emc {
namespace {

bool is_wrong_at(std::span<const Interval> wrong, kernel::Duration time) {
  return std::any_of(wrong.begin(), wrong.end(),
                     [&](const Interval& interval) { return interval.from <= time && time < interval.to; });
}

}  // namespace

kernel::Duration effective_time(std::span<const Interval> wrong, line::Sampling sampling,
                                std::int64_t bit_rate) {
  const bool is_single = sampling.kind == line::Sampling::Kind::mid_bit;
  const kernel::Duration pitch = kernel::levels_duration(1, 16 * bit_rate);
  // Seen from the first sample, the answer changes only where a sample meets an end of an interval.
  std::vector<kernel::Duration> changes;
  for (const Interval& interval : wrong) {
    for (int sample = 0; sample < (is_single ? 1 : 3); ++sample) {
      changes.push_back(interval.from - sample * pitch);
      changes.push_back(interval.to - sample * pitch);
    }
  }
  std::sort(changes.begin(), changes.end());
  kernel::Duration sum{};
  for (std::size_t n = 0; n + 1 < changes.size(); ++n) {
    const kernel::Duration at = changes[n];
    const int samples =
        int{is_wrong_at(wrong, at)} +
        (is_single ? 1 : int{is_wrong_at(wrong, at + pitch)} + int{is_wrong_at(wrong, at + 2 * pitch)});
    if (samples >= 2) sum += changes[n + 1] - at;
  }
  return sum;
}

double flips_per_pulse(const WrongOutput& wrong, line::Sampling sampling, std::int64_t bit_rate) {
  kernel::Duration sum{};
  for (const auto& intervals : wrong.of_level) sum += effective_time(intervals, sampling, bit_rate);
  return static_cast<double>(sum.count()) * static_cast<double>(bit_rate) /
         (2 * static_cast<double>(kernel::kSecond.count()));
}

GilbertElliott fitted_gilbert_elliott(double flips_per_pulse, Repetition repetition, std::int64_t bit_rate) {
  BurstSettings settings;
  settings.repetition = repetition;
  settings.tolerances = Tolerances::none;
  const BurstTiming timing = BurstSchedule(settings, kernel::Random(0)).timing();
  const auto bits = [&](kernel::Duration duration) {
    return static_cast<double>(duration.count()) * static_cast<double>(bit_rate) /
           static_cast<double>(kernel::kSecond.count());
  };
  const kernel::Duration burst = timing.pulses * timing.pitch;
  GilbertElliott fitted;
  fitted.to_good = std::min(1.0, 1 / bits(burst));
  fitted.to_bad = std::min(1.0, 1 / bits(timing.period - burst));
  fitted.good_flip = 0;
  fitted.bad_flip = std::min(1.0, flips_per_pulse * static_cast<double>(timing.pulses) / bits(burst));
  return fitted;
}

}  // namespace fieldproof::emc
