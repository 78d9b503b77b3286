#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "emc/coupling.hpp"
#include "harness/kernel/time.hpp"
#include "harness/line/waveform.hpp"

// The times in which a receiver hears a transmission wrongly, on a fine grid laid over its levels: `ticks`
// per level, a whole number of them.
//
// The two ends of an interval go to the nearest tick. As pulses come at any phase, that lengthens as often as
// it shortens.
namespace fieldproof::emc {

// Ticks [from, to), counted from the start of the transmission.
struct Span {
  std::int64_t from;
  std::int64_t to;

  // Both comparisons are made: branches on a tick can't be predicted.
  bool has(std::int64_t tick) const { return (from <= tick) & (tick < to); }

  friend bool operator==(const Span&, const Span&) = default;
};

// Ticks and the levels that they lie in. A power of two divides faster than another number does.
class TickGrid {
 public:
  explicit constexpr TickGrid(std::int64_t per_level)
      : per_level_(per_level),
        shift_(std::has_single_bit(static_cast<std::uint64_t>(per_level))
                   ? std::countr_zero(static_cast<std::uint64_t>(per_level))
                   : -1) {}

  std::int64_t per_level() const { return per_level_; }
  // Of a tick from 0 on.
  std::int64_t level_of(std::int64_t tick) const { return shift_ < 0 ? tick / per_level_ : tick >> shift_; }
  std::int64_t begin_of(std::int64_t level) const { return level * per_level_; }

 private:
  std::int64_t per_level_;
  int shift_;
};

class WrongSpans {
 public:
  // Forgets everything; what is added then belongs to `sent`.
  void begin(const line::Waveform& sent, const TickGrid& grid);

  // The effect of a pulse; gives the ticks from its first to its last wrong one. Pulses are added in order.
  Span add(kernel::Time pulse, const WrongOutput& wrong);

  // Takes out what is not heard: where the driven level is not the one that is mistaken. What is left is when
  // the line is heard as the opposite of what it is; ordered, apart, within the transmission.
  const std::vector<Span>& resolve();

  const TickGrid& grid() const { return grid_; }

 private:
  std::int64_t tick_of(kernel::Time time) const {
    const double ticks = static_cast<double>((time - sent_->start).count()) * ticks_per_picosecond_ + 0.5;
    const auto whole = static_cast<std::int64_t>(ticks);
    return static_cast<double>(whole) > ticks ? whole - 1 : whole;  // towards zero is up for what is negative
  }
  void resolve(bool level);

  const line::Waveform* sent_ = nullptr;
  TickGrid grid_{1};
  double ticks_per_picosecond_ = 0;
  std::array<std::vector<Span>, 2> of_level_;
  std::vector<Span> heard_;
};

}  // namespace fieldproof::emc
