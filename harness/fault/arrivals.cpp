#include "harness/fault/arrivals.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::fault {

void ArrivalWriter::write(Piece piece, kernel::Duration late) {
  const std::size_t size = sent_.levels.size();
  piece.count = piece.first < size ? std::min(piece.count, size - piece.first) : 0;
  write(sent_.levels, piece, piece.first, late);
}

void ArrivalWriter::write(const line::Levels& levels, Piece part, std::size_t at, kernel::Duration late) {
  if (part.count == 0) return;
  const kernel::Time start =
      kernel::level_time(sent_.start, static_cast<std::int64_t>(at) + shift_levels_, sent_.rate) +
      shift_time_ + late;
  // A gap of nothing is no gap: the arrival goes on.
  if (arrivals_.size() > first_arrival_ && arrivals_.back().end() == start) {
    arrivals_.back().levels.append(levels, part.first, part.count);
    return;
  }
  line::Waveform& arrival = arrivals_.add();
  arrival.start = start;
  arrival.rate = sent_.rate;
  arrival.levels.append(levels, part.first, part.count);
}

void ArrivalWriter::finish() {
  order_by_start(arrivals_, first_arrival_);
  for (std::size_t i = first_arrival_; i + 1 < arrivals_.size(); ++i) {
    cut_back(arrivals_[i], arrivals_[i + 1].start);
  }
  arrivals_.drop_empty();
}

void order_by_start(line::Waveforms& waves, std::size_t first) {
  const auto begin = waves.begin() + static_cast<std::ptrdiff_t>(first);
  const auto is_before = [](const line::Waveform& a, const line::Waveform& b) { return a.start < b.start; };
  // Mostly they are in order, and sorting would take a buffer.
  if (!std::is_sorted(begin, waves.end(), is_before)) std::stable_sort(begin, waves.end(), is_before);
}

void cut_front(line::Waveform& wave, kernel::Time from) {
  const std::size_t first = wave.first_level_at(from);
  if (first == 0) return;
  wave.start = wave.time_of(first);
  wave.levels = wave.levels.slice(first, wave.levels.size() - first);
}

void cut_back(line::Waveform& wave, kernel::Time to) {
  if (wave.end() <= to) return;
  // The last level that is kept ends at `to` or before: the level that begins last at or before `to` goes.
  const std::size_t next = wave.first_level_at(to);
  const bool begins_here = wave.time_of(next) == to;
  wave.levels.resize(begins_here || next == 0 ? next : next - 1);
}

}  // namespace fieldproof::fault
