#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "harness/line/frame_check_16.hpp"

// One station's section of the distributed shift register during a cycle, in octets: what it was loaded with,
// followed by everything that came in. The octet that leaves with the k-th telegram is simply the k-th of
// that line; the register holds the last ones. The frame checks of both sides are taken over the line in one
// go.
//
// Limits: register lengths are whole octets.
namespace fieldproof::interbus {

class ShiftLine {
 public:
  explicit ShiftLine(std::size_t largest_register) : octets_(kRoom + largest_register) {}

  // Begins a cycle with a register of `length` octets; gives the register for loading.
  std::span<std::uint8_t> load(std::size_t length, line::FrameCheck16::State preset) {
    length_ = length;
    count_ = 0;
    is_folded_ = false;
    received_ = sent_ = preset;
    return {octets_.data(), length};
  }

  std::uint8_t shift(std::uint8_t in, const line::FrameCheck16& check) {
    if (count_ == kRoom) fold(check);
    octets_[length_ + count_] = in;
    return octets_[count_++];
  }

  std::size_t count() const { return count_; }  // octets shifted since load() or the last folding
  // Whether at least `octets` (at most kRoom) have been shifted since load().
  bool has_shifted(std::size_t octets) const { return is_folded_ || count_ >= octets; }
  std::span<const std::uint8_t> held() const { return {octets_.data() + count_, length_}; }

  line::FrameCheck16::State received_check(const line::FrameCheck16& check) const {
    return check.update(received_, {octets_.data() + length_, count_});
  }
  line::FrameCheck16::State sent_check(const line::FrameCheck16& check) const {
    return check.update(sent_, {octets_.data(), count_});
  }

 private:
  // More than the longest legal frame; a master that never ends its transfer phase is folded into the checks.
  static constexpr std::size_t kRoom = 2048;

  void fold(const line::FrameCheck16& check) {
    received_ = received_check(check);
    sent_ = sent_check(check);
    is_folded_ = true;
    std::memmove(octets_.data(), octets_.data() + count_, length_);
    count_ = 0;
  }

  std::vector<std::uint8_t> octets_;
  std::size_t length_ = 0;
  std::size_t count_ = 0;
  bool is_folded_ = false;
  line::FrameCheck16::State received_ = 0;
  line::FrameCheck16::State sent_ = 0;
};

}  // namespace fieldproof::interbus
