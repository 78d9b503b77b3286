#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "harness/kernel/time.hpp"
#include "harness/line/waveform.hpp"

// How an asynchronous receiver looks at a line: the falling edge at instant t starts its clock, and bit k of
// the character (the start bit is bit 0) is taken at t + (k + 8/16) bit times, or as the majority of the
// three samples at t + (k + 7/16), (k + 8/16) and (k + 9/16) bit times. Shared by every start-stop receiver:
// characters and telegrams.
//
// Contract: a sample is the level that begins at or before its instant, idle outside the waveform. The edge
// is the begin of a level, so how many levels later a sample is taken is a fraction of two whole numbers, the
// same for each edge; nothing is rounded and nothing accumulated. The receiver's clock starts exactly at the
// edge: the uncertainty of up to one sixteenth of a bit that a free-running sampling clock has is not
// modelled. `bit_rate` is positive and below 2^59 bit/s.
namespace fieldproof::line {

struct Sampling {
  enum class Kind : std::uint8_t { majority_of_three, mid_bit };

  Kind kind = Kind::majority_of_three;

  // The instant of a sixteenth of a bit: 7, 8 and 9 are sampled, 16 is the end of the bit.
  static kernel::Time instant(kernel::Time edge, unsigned bit, unsigned sixteenth, std::int64_t bit_rate) {
    return kernel::level_time(edge, std::int64_t{bit} * 16 + sixteenth, bit_rate * 16);
  }

  // The sixteenths of the first and of the last sample of a bit.
  unsigned first() const { return kind == Kind::mid_bit ? 8 : 7; }
  unsigned last() const { return kind == Kind::mid_bit ? 8 : 9; }

  // When the last sample of a bit is taken: before it nothing about this bit is known.
  kernel::Time decided_at(kernel::Time edge, unsigned bit, std::int64_t bit_rate) const {
    return instant(edge, bit, last(), bit_rate);
  }

  friend bool operator==(const Sampling&, const Sampling&) = default;
};

inline constexpr Sampling kMajorityOfThree{Sampling::Kind::majority_of_three};
inline constexpr Sampling kMidBit{Sampling::Kind::mid_bit};

// The first level at or after `from` that is 0 after a level that is 1, or size(). In front of level 0 the
// line is idle, so level 0 is an edge when it is 0.
std::size_t falling_edge(const Levels& levels, std::size_t from);

// A receiver's look at waveforms of any rate, in the levels of them. `look_at` comes before `start`, and
// `start` before all questions; the waveform outlives them.
class Sampler {
 public:
  // More than the longest character and telegram have; nobody may ask for a later bit.
  static constexpr unsigned kMostBits = 16;

  Sampler(const Sampling& sampling, std::int64_t bit_rate) : sampling_(sampling), bit_rate_(bit_rate) {}

  void look_at(const Waveform& wave) {
    levels_ = &wave.levels;
    if (wave.rate != rate_) fit(wave.rate);
  }

  // The falling edge at level `edge` starts the receiver's clock.
  void start(std::size_t edge) { edge_ = edge; }

  // What the receiver takes bit `bit` for.
  bool sample(unsigned bit) const {
    const Places& places = places_[bit];
    // On a quiet line all samples lie in one level.
    if (places.first == places.last) return at(places.first);
    return int{at(places.first)} + int{at(places.middle)} + int{at(places.last)} >= 2;
  }

  // Whether all of the waveform that a bit depends on is there.
  bool is_decided(unsigned bit) const { return edge_ + places_[bit].behind <= levels_->size(); }

  // The first level that begins at or after the last sample of a bit: from there on the receiver looks for
  // the next edge.
  std::size_t behind(unsigned bit) const { return within(places_[bit].behind); }

  // From where a receiver that has refused the start bit (its sample is idle) looks for the next edge: the
  // last sample at which it saw the line idle.
  std::size_t idle_seen() const {
    return within(at(places_[0].last) ? places_[0].behind : behind_first_middle_);
  }

 private:
  // Levels from the edge on.
  struct Places {
    std::size_t first = 0;  // that is sampled
    std::size_t middle = 0;
    std::size_t last = 0;
    std::size_t behind = 0;  // the first that begins at or behind the last sample
  };

  void fit(std::int64_t rate);
  bool at(std::size_t place) const { return (*levels_)[edge_ + place]; }
  std::size_t within(std::size_t place) const { return std::min(edge_ + place, levels_->size()); }

  Sampling sampling_;
  std::int64_t bit_rate_;
  std::int64_t rate_ = 0;  // that the places are for
  std::array<Places, kMostBits> places_{};
  std::size_t behind_first_middle_ = 0;
  const Levels* levels_ = nullptr;
  std::size_t edge_ = 0;
};

}  // namespace fieldproof::line
