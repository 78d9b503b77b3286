#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/character.hpp"
#include "harness/line/uart.hpp"
#include "harness/line/waveform.hpp"

// Characters of a waveform and back.
//
// Whoever drives gives the line each character as a transmission of its own: a bus reports a transmission at
// its end, so its receivers learn of each character when it is over, as a real receiver does, not of a frame
// when it is over.
namespace fieldproof::line {

class UartCodec {
 public:
  explicit UartCodec(const Uart& uart)
      : uart_(uart), code_(uart.format), receiver_(uart.format, uart.bit_rate) {}

  // Calls sink(UartCharacter) for each character of the waveform in order.
  template <typename Sink>
  void decode(const Waveform& wave, Sink&& sink) {
    received_.clear();
    receiver_.receive(wave, received_);
    for (const CharacterReceiver::Received& one : received_) {
      sink(UartCharacter{one.start, one.busy_until, one.character.data, one.character.is_parity_wrong,
                         one.character.is_stop_missing});
    }
  }

  // Appends the characters of the octets without a gap.
  void append(Levels& levels, std::span<const std::uint8_t> octets) const {
    for (const std::uint8_t octet : octets) code_.append(levels, uart_.character_of(octet));
  }
  // A character with upper data bits of its own.
  void append_character(Levels& levels, std::uint16_t character) const { code_.append(levels, character); }

  // How long the driver is enabled around the characters of a transmission, in bits.
  struct DriverTime {
    unsigned before = 0;
    unsigned after = 0;
  };

  // Drives the characters one after the other, the first start bit at `start`. Gives the end. `line` has
  // drive(Waveform&).
  template <typename Line>
  kernel::Time drive(Line& line, std::span<const std::uint8_t> octets, kernel::Time start,
                     const DriverTime& driver) {
    return drive(line, octets, start, driver, uart_.bit_rate);
  }
  // The same with the clock of a sender whose bit rate is another.
  template <typename Line>
  kernel::Time drive(Line& line, std::span<const std::uint8_t> octets, kernel::Time start,
                     const DriverTime& driver, std::int64_t bit_rate) {
    const std::int64_t levels_per_bit = code_.levels_per_bit();
    const std::int64_t length = code_.levels_per_character();
    kernel::Time end{kernel::Duration::min()};
    for (std::size_t n = 0; n < octets.size(); ++n) {
      const std::int64_t before = n == 0 ? driver.before * levels_per_bit : 0;
      wave_.levels.clear();
      wave_.rate = bit_rate * levels_per_bit;
      // Rounded from the beginning, but not into the character before.
      wave_.start = std::max(
          end, kernel::level_time(start, static_cast<std::int64_t>(n) * length - before, wave_.rate));
      wave_.levels.append_idle(static_cast<std::size_t>(before));
      append(wave_.levels, octets.subspan(n, 1));
      if (n + 1 == octets.size())
        wave_.levels.append_idle(static_cast<std::size_t>(driver.after * levels_per_bit));
      end = wave_.end();
      line.drive(wave_);
    }
    return end;
  }

 private:
  Uart uart_;
  CharacterCode code_;
  CharacterReceiver receiver_;
  std::vector<CharacterReceiver::Received> received_;
  Waveform wave_;
};

}  // namespace fieldproof::line
