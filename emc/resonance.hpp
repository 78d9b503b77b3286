#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "emc/checked_frame.hpp"
#include "emc/coupling.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/time.hpp"

// The resonance of burst pulses with the characters of a line: at which pulse rates do corrupted frames pass
// their block check?
//
// Pulses come at a constant pitch, and so do the characters of a frame. Where some pulses last as long as
// some characters, they hit the same bit of several characters, and an exclusive or cannot see an even number
// of flips in one column. Here frames of random data are put on the line one by one, in the middle of a burst
// whose phase is drawn for each of them, and what the receiver makes of them is counted.
//
// What a pulse does decides as much as its rate. A burst has one polarity, so where it forces the output it
// forces it one way, and at an exact resonance it makes all bits of a column equal: all zeros have an
// exclusive or of 0, and every such frame passes; all ones have it only in frames of an even number of
// characters. Between the two lies a level that is drawn anew for each pulse, so that each bit that is hit is
// wrong by a fair coin: no burst does that, but it is what a flip probability of one half per hit means.
//
// Contract: the counts of a rate are a function of the settings, the rate and the stream alone, whatever else
// a scan looks at. Limits: those of CheckedFrame; the burst is longer than the frame.
namespace fieldproof::emc {

struct PulseTrain {
  std::vector<WrongOutput> effects;  // each pulse has one of them, drawn
  double rate_hz = 100'000;
  double rate_tolerance = 0;  // each frame draws its rate within so much of it on both sides
  double jitter = 0;          // each pulse strays by up to so much of the pitch
};

struct FrameCounts {
  double rate_hz = 0;
  std::uint64_t frames = 0;
  std::uint64_t corrupted = 0;   // of them
  std::uint64_t undetected = 0;  // of those

  double corrupted_share() const;
  double undetected_share() const;  // of the corrupted ones; 0 where there are none
};

constexpr double kFewestPulsesPerSecond = 1;
constexpr double kMostPulsesPerSecond = 1e7;
constexpr double kMostRateTolerance = 0.5;

// `random` is split, not drawn from. A rate or a tolerance beyond these, a jitter that is not from 0 to below
// 1/2, and no effect at all are a kernel::Error (usage).
FrameCounts count_frames_under_pulses(const CheckedFrameFormat& format, const PulseTrain& pulses,
                                      std::uint64_t frames, const kernel::Random& random);

struct RateRange {
  double from_hz = 80'000;
  double to_hz = 120'000;  // with it
  double step_hz = 250;
};

struct ResonanceScan {
  std::vector<FrameCounts> rates;  // ascending
  std::vector<std::size_t> peaks;  // of them, ascending
};

// Each rate of the range with so many frames; `pulses.rate_hz` is not looked at. A range without a rate is a
// kernel::Error (usage).
ResonanceScan resonance_scan(const CheckedFrameFormat& format, PulseTrain pulses, const RateRange& range,
                             std::uint64_t frames, const kernel::Random& random);

// The rates from which the undetected share falls on both sides to a half or less before it is exceeded. Only
// a fall that chance would not make (four standard errors) counts, and one that the scan shows: a share that
// still rises at an end of it is no peak.
std::vector<std::size_t> peaks_of(std::span<const FrameCounts> rates);

}  // namespace fieldproof::emc
