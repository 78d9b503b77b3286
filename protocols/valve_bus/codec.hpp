#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/character.hpp"
#include "harness/line/waveform.hpp"
#include "harness/segment/station.hpp"
#include "protocols/valve_bus/frame.hpp"
#include "protocols/valve_bus/rules.hpp"

// Which characters are which frame. Silence of at least 3.5 characters ends a frame; a gap above 1.5
// characters and below that, or a wrong character, spoils the one in which it lies. How many octets a frame
// must have depends on who listens, so a collected frame may have any number of them.
namespace fieldproof::valve_bus {

struct CollectedFrame {
  // More than these are counted, not kept: no frame is longer.
  static constexpr std::size_t kMostOctets = 8;

  std::array<std::uint8_t, kMostOctets> octets{};
  std::size_t count = 0;
  bool is_spoilt = false;
  kernel::Time start{};       // of its first start bit
  kernel::Time busy_until{};  // end of its last stop bit

  // The octets, when there are exactly so many and nothing spoilt them.
  std::optional<std::span<const std::uint8_t>> whole(std::size_t wanted) const {
    if (is_spoilt || count != wanted) return std::nullopt;
    return std::span<const std::uint8_t>(octets).first(wanted);
  }
};

// The command in five octets, whatever its check is. Four octets, six octets are a broken invariant.
Command command_of(std::span<const std::uint8_t> octets);
Response response_of(std::span<const std::uint8_t> octets);

// A character as a station of this bus hears it.
struct HeardCharacter {
  kernel::Time start{};
  kernel::Time busy_until{};
  std::uint16_t data = 0;  // with the ninth bit, where there is one
  bool is_parity_wrong = false;
  bool is_stop_missing = false;

  std::uint8_t octet() const { return static_cast<std::uint8_t>(data); }
  bool is_good() const { return !is_parity_wrong && !is_stop_missing; }
};

class FrameCollector {
 public:
  explicit FrameCollector(const Rules& rules)
      : longest_gap_(longest_gap(rules)), delimiter_(delimiter(rules)), notice_(character_notice(rules)) {}

  bool is_empty() const { return frame_.count == 0; }
  // When the frame that is being collected ends if nothing more comes; kNever without one.
  kernel::Time ends_at() const { return is_empty() ? kernel::kNever : frame_.busy_until + delimiter_; }

  // When it is known to have ended: a character that began within the delimiter has been heard by then.
  kernel::Time known_at() const { return is_empty() ? kernel::kNever : ends_at() + notice_; }

  // A character that comes later than the delimiter begins a new frame; take the old one first.
  void add(const HeardCharacter& character) {
    if (is_empty()) {
      frame_.start = character.start;
    } else if (character.start - frame_.busy_until > longest_gap_) {
      frame_.is_spoilt = true;
    }
    if (frame_.count < CollectedFrame::kMostOctets) frame_.octets[frame_.count] = character.octet();
    ++frame_.count;
    if (!character.is_good()) frame_.is_spoilt = true;
    frame_.busy_until = character.busy_until;
  }

  const CollectedFrame& frame() const { return frame_; }
  void clear() { frame_ = {}; }

 private:
  kernel::Duration longest_gap_;
  kernel::Duration delimiter_;
  kernel::Duration notice_;
  CollectedFrame frame_;
};

// Characters of a waveform and back.
//
// Whoever drives gives the line each character as a transmission of its own: a bus tells a transmission at
// its end, so its listeners learn of each character when it is over, as a real receiver does, not of a frame
// when it is over.
class CharacterCodec {
 public:
  explicit CharacterCodec(const Rules& rules)
      : rules_(rules), code_(character_format(rules)), receiver_(character_format(rules), rules.bit_rate) {}

  // Calls sink(HeardCharacter) for each character of the waveform in order.
  template <typename Sink>
  void hear(const line::Waveform& wave, Sink&& sink) {
    received_.clear();
    receiver_.receive(wave, received_);
    for (const line::CharacterReceiver::Received& one : received_) {
      sink(HeardCharacter{one.start, one.busy_until, one.character.data, one.character.is_parity_wrong,
                          one.character.is_stop_missing});
    }
  }

  // Appends the characters without a gap, one level a bit.
  void append(line::Levels& levels, std::span<const std::uint8_t> octets) const {
    for (const std::uint8_t octet : octets) code_.append(levels, written_character(rules_, octet));
  }

  // How long the driver is on around the characters of a transmission, in bits.
  struct DriverTime {
    unsigned before = 0;
    unsigned behind = 0;
  };

  // Drives the characters one after the other, the first start bit at `start`. Gives the end.
  kernel::Time drive(segment::Port& line, std::span<const std::uint8_t> octets, kernel::Time start,
                     const DriverTime& driver) {
    return drive(line, octets, start, driver, rules_.bit_rate);
  }
  // The same with the clock of a sender whose bit rate is another.
  kernel::Time drive(segment::Port& line, std::span<const std::uint8_t> octets, kernel::Time start,
                     const DriverTime& driver, std::int64_t bit_rate) {
    const std::int64_t length = code_.levels_per_character();
    kernel::Time end{kernel::Duration::min()};
    for (std::size_t n = 0; n < octets.size(); ++n) {
      const unsigned before = n == 0 ? driver.before : 0;
      wave_.levels.clear();
      wave_.rate = bit_rate;
      // Rounded from the beginning, but not into the character before.
      wave_.start = std::max(
          end, kernel::level_time(start, static_cast<std::int64_t>(n) * length - before, wave_.rate));
      wave_.levels.append_idle(before);
      append(wave_.levels, octets.subspan(n, 1));
      if (n + 1 == octets.size()) wave_.levels.append_idle(driver.behind);
      end = wave_.end();
      line.drive(wave_);
    }
    return end;
  }

  // A character as the line code has it, with a ninth bit of its own.
  void append_character(line::Levels& levels, std::uint16_t character) const {
    code_.append(levels, character);
  }

 private:
  Rules rules_;
  line::CharacterCode code_;
  line::CharacterReceiver receiver_;
  std::vector<line::CharacterReceiver::Received> received_;
  line::Waveform wave_;
};

}  // namespace fieldproof::valve_bus
