#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "harness/line/waveform.hpp"

namespace fieldproof::line {

// A list of waveforms that is filled and cleared again and again: it keeps the memory of what it held before,
// so that filling it costs no allocation.
class Waveforms {
 public:
  Waveforms() = default;
  Waveforms(const Waveforms&) = default;
  Waveforms& operator=(const Waveforms&) = default;
  // What is moved from holds none.
  Waveforms(Waveforms&& other) noexcept
      : waves_(std::move(other.waves_)), size_(std::exchange(other.size_, 0)) {}
  Waveforms& operator=(Waveforms&& other) noexcept {
    std::swap(waves_, other.waves_);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }
  ~Waveforms() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  Waveform* data() { return waves_.data(); }
  const Waveform* data() const { return waves_.data(); }
  Waveform* begin() { return data(); }
  const Waveform* begin() const { return data(); }
  Waveform* end() { return data() + size_; }
  const Waveform* end() const { return data() + size_; }
  Waveform& operator[](std::size_t n) { return waves_[n]; }
  const Waveform& operator[](std::size_t n) const { return waves_[n]; }
  Waveform& front() { return waves_.front(); }
  const Waveform& front() const { return waves_.front(); }
  Waveform& back() { return waves_[size_ - 1]; }
  const Waveform& back() const { return waves_[size_ - 1]; }

  // A waveform without levels, to be filled. References to others may end.
  Waveform& add() {
    Waveform& wave = next();
    wave.start = {};
    wave.rate = 1;
    wave.levels.clear();
    return wave;
  }
  // A copy of a waveform that is no part of this list.
  Waveform& add(const Waveform& wave) { return next() = wave; }
  // The waveform itself, by exchange: what is left in its place is memory, to be cleared.
  void take(Waveform& wave) { std::swap(next(), wave); }

  void clear() { size_ = 0; }
  void drop_first(std::size_t count) {
    for (std::size_t n = count; n < size_; ++n) std::swap(waves_[n - count], waves_[n]);
    size_ -= count;
  }
  // Drops those without levels.
  void drop_empty() {
    std::size_t kept = 0;
    for (std::size_t n = 0; n < size_; ++n) {
      if (!waves_[n].levels.empty()) std::swap(waves_[kept++], waves_[n]);
    }
    size_ = kept;
  }

 private:
  Waveform& next() {
    if (size_ == waves_.size()) waves_.emplace_back();
    return waves_[size_++];
  }

  std::vector<Waveform> waves_;  // those from size_ on are kept for their memory
  std::size_t size_ = 0;
};

}  // namespace fieldproof::line
