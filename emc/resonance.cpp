#include "emc/resonance.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

constexpr double kStandardErrors = 4;

[[noreturn]] void refuse_pulses(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::usage, sentence);
}

void require_pulses(const PulseTrain& pulses) {
  if (!(pulses.rate_hz >= kFewestPulsesPerSecond && pulses.rate_hz <= kMostPulsesPerSecond)) {
    refuse_pulses(fmt::format("pulses cannot come at {} Hz; the rate is {} to {} Hz.", pulses.rate_hz,
                              kFewestPulsesPerSecond, kMostPulsesPerSecond));
  }
  if (!(pulses.rate_tolerance >= 0 && pulses.rate_tolerance <= kMostRateTolerance)) {
    refuse_pulses(fmt::format("a pulse rate cannot have a tolerance of {}; it is 0 to {}.",
                              pulses.rate_tolerance, kMostRateTolerance));
  }
  if (!(pulses.jitter >= 0 && pulses.jitter < 0.5)) {
    refuse_pulses(
        fmt::format("pulses cannot stray by {} of their pitch and keep their order; it is 0 to below 0.5.",
                    pulses.jitter));
  }
  if (pulses.effects.empty()) refuse_pulses("pulses without an effect have no resonance; give them one.");
}

kernel::Duration rounded(double picoseconds) {
  return kernel::Duration{std::llround(picoseconds)};
}

// Frames one after the other, each at a place of its own in a burst.
class FramesUnderPulses {
 public:
  FramesUnderPulses(const CheckedFrameFormat& format, const PulseTrain& train, const kernel::Random& random)
      : train_(train), frame_(format, train.effects), random_(random), message_(format.characters - 1) {
    most_data_ = std::uint64_t{1} << format.character.data_bits;
  }

  FrameFate next() {
    draw_pulses();
    if (pulses_.empty()) return FrameFate::intact;
    for (std::uint16_t& character : message_) {
      character = static_cast<std::uint16_t>(random_.below(most_data_));
    }
    return frame_.fate(message_, pulses_);
  }

 private:
  void draw_pulses() {
    double rate = train_.rate_hz;
    if (train_.rate_tolerance > 0) rate *= 1 + train_.rate_tolerance * (2 * random_.uniform() - 1);
    const double pitch = static_cast<double>(kernel::kSecond.count()) / rate;  // in picoseconds
    const kernel::Duration jitter = rounded(pitch * train_.jitter);
    // All that can reach into the frame or into the silence around it.
    const kernel::Time until = frame_.end() - frame_.reach().from + jitter;
    const kernel::Time from = kernel::kStart - frame_.reach().to - jitter;
    const double phase = pitch * random_.uniform();
    pulses_.clear();
    // Each place is rounded once: what a rounded pitch adds up to over a frame can be seen.
    for (double n = 0;; ++n) {
      FramePulse pulse{from + rounded(phase + n * pitch), 0};
      if (pulse.time >= until) break;
      if (train_.jitter > 0) pulse.time += kernel::Duration{random_.between(-jitter.count(), jitter.count())};
      if (train_.effects.size() > 1) pulse.effect = random_.below(train_.effects.size());
      pulses_.push_back(pulse);
    }
  }

  const PulseTrain& train_;
  CheckedFrame frame_;
  kernel::Random random_;
  std::uint64_t most_data_;
  std::vector<std::uint16_t> message_;
  std::vector<FramePulse> pulses_;
};

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

// Of the share of undetected frames, squared; where none was seen, that of one.
double variance_of_share(const FrameCounts& counts) {
  const auto corrupted = static_cast<double>(counts.corrupted);
  return (static_cast<double>(counts.undetected) + 1) / (corrupted * corrupted);
}

bool is_far_below(const FrameCounts& valley, const FrameCounts& peak) {
  if (valley.corrupted == 0 || valley.undetected_share() > peak.undetected_share() / 2) return false;
  const double fall = peak.undetected_share() - valley.undetected_share();
  return fall > kStandardErrors * std::sqrt(variance_of_share(peak) + variance_of_share(valley));
}

// Whether the share falls far, one rate after the other in this direction, before it is exceeded. Of equal
// shares the first one is the peak.
bool falls_from(std::span<const FrameCounts> rates, std::size_t peak, bool is_upward) {
  const double height = rates[peak].undetected_share();
  for (std::size_t n = peak; is_upward ? n + 1 < rates.size() : n > 0;) {
    n = is_upward ? n + 1 : n - 1;
    const double here = rates[n].undetected_share();
    if (is_upward ? here > height : here >= height) return false;
    if (is_far_below(rates[n], rates[peak])) return true;
  }
  return false;
}

}  // namespace

double FrameCounts::corrupted_share() const {
  return share(corrupted, frames);
}

double FrameCounts::undetected_share() const {
  return share(undetected, corrupted);
}

FrameCounts count_frames_under_pulses(const CheckedFrameFormat& format, const PulseTrain& pulses,
                                      std::uint64_t frames, const kernel::Random& random) {
  require_pulses(pulses);
  // By the rate in thousandths, so that a rate draws the same in every scan.
  FramesUnderPulses line(format, pulses,
                         random.split(static_cast<std::uint64_t>(std::llround(pulses.rate_hz * 1000))));
  FrameCounts counts{pulses.rate_hz, frames, 0, 0};
  for (std::uint64_t n = 0; n < frames; ++n) {
    const FrameFate fate = line.next();
    counts.corrupted += fate == FrameFate::intact ? 0U : 1U;
    counts.undetected += fate == FrameFate::undetected ? 1U : 0U;
  }
  return counts;
}

ResonanceScan resonance_scan(const CheckedFrameFormat& format, PulseTrain pulses, const RateRange& range,
                             std::uint64_t frames, const kernel::Random& random) {
  if (!(range.step_hz > 0 && range.from_hz > 0 && range.to_hz >= range.from_hz)) {
    refuse_pulses(fmt::format("there is no pulse rate from {} to {} Hz in steps of {} Hz.", range.from_hz,
                              range.to_hz, range.step_hz));
  }
  // The last step may be short of the end by a rounding.
  const auto steps = static_cast<std::uint64_t>((range.to_hz - range.from_hz) / range.step_hz + 1e-6);
  ResonanceScan scan;
  for (std::uint64_t n = 0; n <= steps; ++n) {
    pulses.rate_hz = range.from_hz + static_cast<double>(n) * range.step_hz;
    scan.rates.push_back(count_frames_under_pulses(format, pulses, frames, random));
  }
  scan.peaks = peaks_of(scan.rates);
  return scan;
}

std::vector<std::size_t> peaks_of(std::span<const FrameCounts> rates) {
  std::vector<std::size_t> peaks;
  for (std::size_t n = 0; n < rates.size(); ++n) {
    if (falls_from(rates, n, false) && falls_from(rates, n, true)) peaks.push_back(n);
  }
  return peaks;
}

}  // namespace fieldproof::emc
