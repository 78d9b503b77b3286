#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "emc/framing.hpp"
#include "emc/wrong_spans.hpp"
#include "harness/line/sampling.hpp"
#include "harness/line/waveform.hpp"

// What a declared receiver makes of wrong times in a transmission of its own bit rate, without being asked.
//
// All edges of such a transmission lie between bits, so a receiver that is in step samples bit k of the
// transmission at sixteenths 7, 8 and 9 of that bit and nowhere else, and looks for edges only from the last
// sample of a stop bit on. From this follows, exactly:
//   - a wrong time inside a unit that leaves the edge of its start alone acts through the samples of its bits
//     and not at all otherwise;
//   - bits with the role `sampled` change values and move no other bit: flipping them at the bit rate gives
//     the same as the wrong wave itself;
//   - an edge on the idle line whose samples are idle again is refused, and leaves nothing after when no
//     true edge came before the last of these samples.
// Everything else (start and stop bits that are sampled wrongly, bits that decide about the framing, edges
// near a start, glitches that may pass for a start) is left to the receiver: `is_unclear`.
namespace fieldproof::emc {

class SampledImpact {
 public:
  // Without a framing everything is unclear; it must outlive the impact.
  SampledImpact(const Framing* framing, line::Sampling sampling, bool validates_start)
      : framing_(framing), sampling_(sampling), validates_start_(validates_start) {}

  // `heard` is on a grid with a multiple of 16 ticks in a bit, and lies within the levels.
  void judge(const line::Levels& levels, const std::vector<Span>& heard, const TickGrid& grid);

  bool is_unclear() const { return is_unclear_; }
  const std::vector<std::size_t>& flipped_bits() const { return flipped_; }  // in order

 private:
  std::int64_t sixteenths(std::int64_t count) const { return count * (grid_.per_level() / 16); }
  std::int64_t first_sample() const {
    return sixteenths(sampling_.kind == line::Sampling::Kind::mid_bit ? 8 : 7);
  }
  std::int64_t last_sample() const {
    return sixteenths(sampling_.kind == line::Sampling::Kind::mid_bit ? 8 : 9);
  }

  // Where the judgement of the line goes on: a tick, and the span in which it lies or that follows it.
  struct Place {
    std::size_t span;
    std::int64_t at;
  };

  void judge_in_unit(const FramedUnit& unit, Place& place);
  void judge_on_idle_line(std::int64_t idle_until, Place& place);
  void pass_bit(std::int64_t bit, Place& place) const;
  bool is_sampled_wrong(std::int64_t bit, std::size_t first_span) const;

  const Framing* framing_;
  line::Sampling sampling_;
  bool validates_start_;

  std::vector<FramedUnit> units_;
  const std::vector<Span>* heard_ = nullptr;
  TickGrid grid_{16};
  bool is_unclear_ = false;
  std::vector<std::size_t> flipped_;
};

}  // namespace fieldproof::emc
