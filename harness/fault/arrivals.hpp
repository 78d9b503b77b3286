#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "harness/kernel/time.hpp"
#include "harness/line/waveforms.hpp"

// What arrives of a transmission that a fault takes apart: pieces of its levels, each at its own time. Pieces
// that follow each other without a gap become one arrival again, so an inserted telegram gives one train.
//
// Contract: a shift in levels keeps the grid of the transmission (the start of each piece is rounded once); a
// shift in time is added to it. `arrivals` from `first_arrival` on belong to the transmission.
namespace fieldproof::fault {

// Levels [first, first + count) of a transmission.
struct Piece {
  std::size_t first = 0;
  std::size_t count = 0;

  std::size_t end() const { return first + count; }
  bool touches(const Piece& other) const {
    return count != 0 && other.count != 0 && first < other.end() && other.first < end();
  }
  friend bool operator==(const Piece&, const Piece&) = default;
};

class ArrivalWriter {
 public:
  ArrivalWriter(const line::Waveform& sent, line::Waveforms& arrivals)
      : sent_(sent), arrivals_(arrivals), first_arrival_(arrivals.size()) {}

  // What is written from now on arrives later (or earlier) than it was sent, in addition to what holds.
  void shift(std::int64_t levels) { shift_levels_ += levels; }
  void shift(kernel::Duration duration) {
    // Many long gaps end where times are still far from their range.
    shift_time_ = std::min(shift_time_ + duration, kFarthest);
  }

  // Levels of the transmission at their shifted time, and `late` after it.
  void write(Piece piece, kernel::Duration late = {});

  // Other levels of the same rate at the shifted time of level `at`.
  void write(const line::Levels& levels, Piece part, std::size_t at, kernel::Duration late = {});

  // Orders the arrivals by start; where two overlap, the rest of the earlier one is lost.
  void finish();

 private:
  static constexpr kernel::Duration kFarthest{4'000'000'000'000'000'000};

  const line::Waveform& sent_;
  line::Waveforms& arrivals_;
  std::size_t first_arrival_;
  std::int64_t shift_levels_ = 0;
  kernel::Duration shift_time_{};
};

// Orders the waveforms from index `first` on by their start; equal starts stay in order.
void order_by_start(line::Waveforms& waves, std::size_t first);

// Takes away the levels that begin before `from`; the start moves to the first level that is left.
void cut_front(line::Waveform& wave, kernel::Time from);
// Takes away the levels that end after `to`.
void cut_back(line::Waveform& wave, kernel::Time to);

}  // namespace fieldproof::fault
