#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "harness/kernel/time.hpp"

// The unit on the wire: a start time, the rate of the levels and the packed levels of one transmission (a
// character, a telegram, a train of telegrams, a whole frame). One event per transmission, not one per edge.
//
// Level n lasts from level_time(start, n, rate) to level_time(start, n + 1, rate); positions are computed
// from the start and rounded once, never accumulated. Outside the packed levels the line is idle (level 1). A
// waveform may be finer than the bits that it carries (rate a multiple of the bit rate): glitches and jitter
// are written that way.
namespace fieldproof::line {

// Packed levels; level n is bit n % 64 of word n / 64. Reading past the end gives the idle level 1.
class Levels {
 public:
  Levels() { reserve(kInitialLevels); }
  Levels(const Levels&) = default;
  Levels& operator=(const Levels&) = default;
  // What is moved from is memory: it is cleared before it is filled again.
  Levels(Levels&& other) noexcept
      : words_(std::move(other.words_)),
        capacity_(std::exchange(other.capacity_, 0)),
        size_(std::exchange(other.size_, 0)) {}
  Levels& operator=(Levels&& other) noexcept {
    std::swap(words_, other.words_);
    std::swap(capacity_, other.capacity_);
    std::swap(size_, other.size_);
    return *this;
  }
  ~Levels() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  bool operator[](std::size_t n) const { return n >= size_ || ((words_[n / 64] >> (n % 64)) & 1U) != 0; }

  // The 64 levels from `first` on, the first in bit 0. `first` may be at most size().
  std::uint64_t window(std::size_t first) const {
    const std::size_t word = first / 64;
    const unsigned shift = first % 64;
    // Two shifts, because a shift by 64 is undefined and a branch is slower.
    return (words_[word] >> shift) | ((words_[word + 1] << 1) << (63 - shift));
  }

  // The packed words that hold size() levels; levels beyond the end are 1.
  const std::uint64_t* words() const { return words_.data(); }
  std::size_t word_count() const { return (size_ + 63) / 64; }

  // Appends the lowest `count` (0..64) bits, the lowest first.
  void append(std::uint64_t bits, unsigned count) {
    reserve(size_ + count);
    const std::uint64_t zeros = ~bits & mask(count);
    const unsigned shift = size_ % 64;
    words_[size_ / 64] &= ~(zeros << shift);
    words_[size_ / 64 + 1] &= ~((zeros >> 1) >> (63 - shift));
    size_ += count;
  }

  void append_idle(std::size_t count) {
    reserve(size_ + count);
    size_ += count;
  }

  // Room for `count` levels in all, for `place`.
  void make_room(std::size_t count) { reserve(count); }

  // Like append of the idle levels up to level `at` and then of `count` (1..64) levels, without asking for
  // room: for loops that have made it before.
  void place(std::size_t at, std::uint64_t bits, unsigned count) {
    const std::uint64_t zeros = ~bits & mask(count);
    const unsigned shift = at % 64;
    std::uint64_t* const word = words_.data() + at / 64;
    word[0] &= ~(zeros << shift);
    // The branch is cheaper than a second word each time: telegrams come at a pitch that a predictor learns.
    if (shift + count > 64) word[1] &= ~(zeros >> (64 - shift));
    size_ = at + count;
  }

  void append_fill(bool level, std::size_t count);
  void append(const Levels& other);
  // Levels [first, first + count) of the other, idle beyond its end.
  void append(const Levels& other, std::size_t first, std::size_t count);
  // Each level of the other `times` times, at least once.
  void append_stretched(const Levels& other, std::size_t times);

  // Positions at or beyond the end are a broken invariant.
  void flip(std::size_t n);
  void set(std::size_t n, bool level);
  // Levels [first, end).
  void fill(std::size_t first, std::size_t end, bool level);
  void invert(std::size_t first, std::size_t end);

  void clear();
  void resize(std::size_t size);  // new levels are idle

  // The end of the run of equal levels that begins at `first`, which lies in the levels.
  std::size_t end_of_run(std::size_t first) const {
    const std::uint64_t equal = (*this)[first] ? ~std::uint64_t{0} : 0;
    for (std::size_t n = first; n < size_; n += 64) {
      const std::uint64_t others = window(n) ^ equal;
      if (others != 0) return std::min(size_, n + static_cast<std::size_t>(std::countr_zero(others)));
    }
    return size_;
  }

  // Levels [first, first + count), idle beyond the end.
  Levels slice(std::size_t first, std::size_t count) const;

  std::string text() const;  // "0101…", the first level first
  // The levels that are written so; what is no '1' is a 0.
  static Levels of_text(std::string_view text);

  friend bool operator==(const Levels& a, const Levels& b);

 private:
  static constexpr std::size_t kInitialLevels = 256;
  static constexpr std::size_t kWordLevels = 64;

  static constexpr std::uint64_t mask(unsigned count) {
    return count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
  }

  // Room for `levels` levels and one guard word of idle levels after them.
  void reserve(std::size_t levels) {
    if (levels + 64 > capacity_) grow(levels);
  }
  void grow(std::size_t levels);

  std::vector<std::uint64_t> words_;
  std::size_t capacity_ = 0;  // in levels, without the guard
  std::size_t size_ = 0;
};

struct Waveform {
  kernel::Time start{};
  std::int64_t rate = 1;  // levels per second
  Levels levels;

  kernel::Time time_of(std::size_t n) const {
    return kernel::level_time(start, static_cast<std::int64_t>(n), rate);
  }
  kernel::Time end() const { return time_of(levels.size()); }
  // The level at an instant; idle outside.
  bool at(kernel::Time time) const;
  // The first level whose start is at or after `time`, in 0..size().
  std::size_t first_level_at(kernel::Time time) const;
};

}  // namespace fieldproof::line
