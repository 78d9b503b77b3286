#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "harness/kernel/time.hpp"
#include "harness/line/waveform.hpp"

// How an asynchronous receiver looks at a line: the falling edge at instant t starts its clock, and bit k of
// the character (the start bit is bit 0) is taken at t + (k + 8/16) bit times, or as the majority of the
// three samples at t + (k + 7/16), (k + 8/16) and (k + 9/16) bit times. Shared by every start-stop receiver:
// characters and telegrams.
//
// Contract: a sample is the level that begins at or before its instant, idle outside the waveform. Sampling
// instants are computed from the edge and rounded once, never accumulated; where they lie on the borders of
// levels (`Sampler`) nothing is rounded at all. The receiver's clock starts exactly at the edge: the
// uncertainty of up to one sixteenth of a bit that a free-running sampling clock has is not modelled.
// `bit_rate` is positive and below 2^59 bit/s.
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

// One receiver's look at one waveform, in the levels of it. `start` comes before all other questions.
class Sampler {
 public:
  Sampler(const Waveform& wave, const Sampling& sampling, std::int64_t bit_rate)
      : wave_(wave), sampling_(sampling), bit_rate_(bit_rate) {
    // No number of levels per sixteenth that is whole: 0, and instants decide.
    if (wave.rate % (16 * bit_rate) == 0) sixteenth_ = static_cast<std::size_t>(wave.rate / (16 * bit_rate));
  }

  // The falling edge at level `edge` starts the receiver's clock.
  void start(std::size_t edge) {
    edge_ = edge;
    if (!is_on_grid()) edge_time_ = wave_.time_of(edge);
  }

  // What the receiver takes bit `bit` for.
  bool sample(unsigned bit) const {
    if (!is_on_grid()) return sampling_.sample(wave_, edge_time_, bit, bit_rate_);
    if (sampling_.kind == Sampling::Kind::mid_bit) return at(bit, 8);
    return int{at(bit, 7)} + int{at(bit, 8)} + int{at(bit, 9)} >= 2;
  }

  // Whether all of the waveform that a bit depends on is there.
  bool is_decided(unsigned bit) const {
    return is_on_grid() ? level(bit, last()) <= wave_.levels.size()
                        : sampling_.decided_at(edge_time_, bit, bit_rate_) <= wave_.end();
  }

  // The first level behind the last sample of a bit: from there on the receiver looks for the next edge.
  std::size_t behind(unsigned bit) const {
    return is_on_grid() ? std::min(level(bit, last()), wave_.levels.size())
                        : level_from(sampling_.decided_at(edge_time_, bit, bit_rate_));
  }

  // From where a receiver that has refused the start bit (its sample is idle) looks for the next edge: the
  // last sample at which it saw the line idle.
  std::size_t idle_seen() const {
    return is_on_grid() ? std::min(level(0, at(0, last()) ? last() : 8), wave_.levels.size())
                        : level_from(sampling_.idle_seen_at(wave_, edge_time_, bit_rate_));
  }

 private:
  bool is_on_grid() const { return sixteenth_ != 0; }
  unsigned last() const { return sampling_.kind == Sampling::Kind::mid_bit ? 8 : 9; }
  std::size_t level(unsigned bit, unsigned sixteenth) const {
    return edge_ + (std::size_t{bit} * 16 + sixteenth) * sixteenth_;
  }
  // Behind the edge even where half a bit rounds to nothing.
  std::size_t level_from(kernel::Time time) const { return std::max(wave_.first_level_at(time), edge_ + 1); }
  bool at(unsigned bit, unsigned sixteenth) const { return wave_.levels[level(bit, sixteenth)]; }

  const Waveform& wave_;
  Sampling sampling_;
  std::int64_t bit_rate_;
  std::size_t sixteenth_ = 0;  // of a bit, in levels
  std::size_t edge_ = 0;
  kernel::Time edge_time_{};
};

}  // namespace fieldproof::line
