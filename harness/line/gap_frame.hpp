#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "harness/kernel/time.hpp"
#include "harness/line/uart.hpp"

// Which UART characters are which frame, where silence delimits frames: an inter-character gap of at least
// the delimiter ends a frame; one that is longer than the longest gap and shorter than that, or a wrong
// character, spoils the frame in which it lies. How many octets a frame must have depends on who receives it,
// so a collected frame may have any number of them.
namespace fieldproof::line {

struct InterCharacterGaps {
  kernel::Duration longest{};    // inside a frame
  kernel::Duration delimiter{};  // at least so much silence between frames
  kernel::Duration notice{};     // after which a receiver knows that no character has begun
};

// `most`: more octets are counted, not kept; no frame of the protocol is longer.
template <std::size_t most>
struct GapFrame {
  static constexpr std::size_t kMostOctets = most;

  std::array<std::uint8_t, most> octets{};
  std::size_t count = 0;
  bool is_spoilt = false;
  kernel::Time start{};       // of its first start bit
  kernel::Time busy_until{};  // end of its last stop bit

  // The octets, when there are exactly so many and nothing spoilt them.
  std::optional<std::span<const std::uint8_t>> whole(std::size_t length) const {
    if (is_spoilt || count != length || length > most) return std::nullopt;
    return std::span<const std::uint8_t>(octets).first(length);
  }
};

template <std::size_t most>
class GapFrameCollector {
 public:
  explicit GapFrameCollector(const InterCharacterGaps& gaps) : gaps_(gaps) {}

  bool is_empty() const { return frame_.count == 0; }
  // When the frame that is being collected ends if nothing more comes; kNever without one.
  kernel::Time ends_at() const { return is_empty() ? kernel::kNever : frame_.busy_until + gaps_.delimiter; }

  // When it is known to have ended: a character that began within the delimiter has been received by then.
  kernel::Time known_at() const { return is_empty() ? kernel::kNever : ends_at() + gaps_.notice; }

  // A character that comes later than the delimiter begins a new frame; take the old one first.
  void add(const UartCharacter& character) {
    if (is_empty()) {
      frame_.start = character.start;
    } else if (character.start - frame_.busy_until > gaps_.longest) {
      frame_.is_spoilt = true;
    }
    if (frame_.count < most) frame_.octets[frame_.count] = character.octet();
    ++frame_.count;
    if (!character.is_good()) frame_.is_spoilt = true;
    frame_.busy_until = character.busy_until;
  }

  const GapFrame<most>& frame() const { return frame_; }
  void clear() { frame_ = {}; }

 private:
  InterCharacterGaps gaps_;
  GapFrame<most> frame_;
};

}  // namespace fieldproof::line
