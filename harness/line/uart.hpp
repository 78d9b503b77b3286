#pragma once

#include <cstdint>

#include "harness/kernel/time.hpp"
#include "harness/line/character.hpp"

// A line of UART characters, as a standard or a project sets it: bit rate, format, and the times that follow
// from both. Each protocol makes one of its rules.
namespace fieldproof::line {

struct Uart {
  std::int64_t bit_rate = 0;          // bit/s
  CharacterFormat format{};           // with all data bits of a character
  std::uint16_t upper_data_bits = 0;  // of each character that is sent, above its octet

  kernel::Duration bits(std::int64_t count) const { return kernel::levels_duration(count, bit_rate); }
  kernel::Duration half_characters(std::int64_t count) const {
    // Quarter bits: half a character of eleven bits is no whole number of half bits times two.
    return kernel::levels_duration(count * format.half_bits(), 4 * bit_rate);
  }
  kernel::Duration character_time() const { return half_characters(2); }
  // A receiver learns of a character when it is over, so of silence it is only sure a character later; a bit
  // more is for a sender whose clock is slow.
  kernel::Duration character_notice() const { return character_time() + bits(1); }

  // Half bits, where there are one and a half stop bits.
  unsigned levels_per_bit() const { return CharacterCode::levels_per_bit(format); }
  std::uint16_t character_of(std::uint8_t octet) const {
    return static_cast<std::uint16_t>(octet | upper_data_bits);
  }
  // As a UART of eight data bits sends the same: a ninth bit that never changes is a parity bit that never
  // does. Nine data bits with a parity bit after them are a broken invariant.
  CharacterFormat eight_bit_format() const;

  friend bool operator==(const Uart&, const Uart&) = default;
};

// A character as a station receives it.
struct UartCharacter {
  kernel::Time start{};       // of its start bit
  kernel::Time busy_until{};  // end of its last stop bit, or of the low line after it
  std::uint16_t data = 0;     // with a ninth bit, where the format has one
  bool is_parity_wrong = false;
  bool is_stop_missing = false;

  std::uint8_t octet() const { return static_cast<std::uint8_t>(data); }
  bool is_good() const { return !is_parity_wrong && !is_stop_missing; }

  friend bool operator==(const UartCharacter&, const UartCharacter&) = default;
};

}  // namespace fieldproof::line
