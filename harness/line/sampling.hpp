#pragma once

#include <cstddef>
#include <cstdint>

#include "harness/kernel/time.hpp"
#include "harness/line/waveform.hpp"

// How an asynchronous receiver looks at a line: the falling edge at instant t starts its clock, and bit k of
// the character (the start bit is bit 0) is taken at t + (k + 8/16) bit times, or as the majority of the
// three samples at t + (k + 7/16), (k + 8/16) and (k + 9/16) bit times. Shared by every start-stop receiver:
// characters and telegrams.
//
// Contract: sampling instants are computed from the edge and rounded once, never accumulated; a sample is the
// level that begins at or before its instant, idle outside the waveform. The receiver's clock starts exactly
// at the edge: the uncertainty of up to one sixteenth of a bit that a free-running sampling clock has is not
// modelled. `bit_rate` is positive and at most 2^59 bit/s.
namespace fieldproof::line {

struct Sampling {
  enum class Kind : std::uint8_t { majority_of_three, mid_bit };

  Kind kind = Kind::majority_of_three;

  // The instant of a sixteenth of a bit: 7, 8 and 9 are sampled, 16 is the end of the bit.
  static kernel::Time instant(kernel::Time edge, unsigned bit, unsigned sixteenth, std::int64_t bit_rate) {
    return kernel::level_time(edge, std::int64_t{bit} * 16 + sixteenth, bit_rate * 16);
  }

  // What the receiver takes bit `bit` for.
  bool sample(const Waveform& wave, kernel::Time edge, unsigned bit, std::int64_t bit_rate) const;

  // The last instant that the answer of `sample` depends on: before it nothing about this bit is known.
  kernel::Time decided_at(kernel::Time edge, unsigned bit, std::int64_t bit_rate) const {
    return instant(edge, bit, kind == Kind::mid_bit ? 8 : 9, bit_rate);
  }

  // From where a receiver that has refused a start bit (`sample` of bit 0 gave idle) looks for the next edge:
  // the last sample at which it saw the line idle.
  kernel::Time idle_seen_at(const Waveform& wave, kernel::Time edge, std::int64_t bit_rate) const;

  friend bool operator==(const Sampling&, const Sampling&) = default;
};

// The first level at or after `from` that is 0 behind a level that is 1, or size(). In front of level 0 the
// line is idle, so level 0 is an edge when it is 0.
std::size_t falling_edge(const Levels& levels, std::size_t from);

// The first falling edge at or after an instant, or size().
std::size_t falling_edge_at(const Waveform& wave, kernel::Time from);

}  // namespace fieldproof::line
