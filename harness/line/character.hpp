#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/sampling.hpp"
#include "harness/line/waveform.hpp"

// Start-stop characters (UART), shared by the protocols that are built on them: a start bit (0), 5 to 9 data
// bits, the lowest first, perhaps a parity bit, one, one and a half or two stop bits (1).
//
// Decoding never fails: a wrong parity bit, a missing stop bit (framing error) and a break are values. Two
// decoders are here. `decode` takes levels that are exactly bit-wide (so not one and a half stop bits, which
// are written in half bits). `CharacterReceiver` takes a waveform of any rate and samples it as a real
// receiver does; on bit-wide waveforms it finds the same.
//
// A receiver looks at one stop bit, however many are sent, and looks for the next start as soon as it has
// sampled it. After a framing error it waits until the line has been idle before it takes an edge for a
// start; a character that is all zero with its stop bit is a break.
namespace fieldproof::line {

enum class Parity : std::uint8_t { none, even, odd, mark, space };
enum class StopBits : std::uint8_t { one, one_and_a_half, two };

struct CharacterFormat {
  unsigned data_bits = 8;  // 5..9
  Parity parity = Parity::none;
  StopBits stop_bits = StopBits::one;

  // In half bits, because of the one and a half stop bits.
  unsigned half_bits() const {
    const unsigned stop = stop_bits == StopBits::one ? 2 : stop_bits == StopBits::two ? 4 : 3;
    return 2 * bits_before_stop() + stop;
  }
  unsigned bits_before_stop() const { return 1 + data_bits + (parity == Parity::none ? 0U : 1U); }
  // "8e1", "7o2", "9n1.5"
  std::string text() const;

  friend bool operator==(const CharacterFormat&, const CharacterFormat&) = default;
};

struct Character {
  std::uint32_t level = 0;  // the level at which its start bit begins
  std::uint16_t data = 0;
  bool is_parity_wrong = false;
  bool is_stop_missing = false;
  bool is_break = false;  // all of it is 0; then is_stop_missing too

  bool is_good() const { return !is_parity_wrong && !is_stop_missing; }
  friend bool operator==(const Character&, const Character&) = default;
};

class CharacterCode {
 public:
  // A format with data bits out of 5..9 is a broken invariant.
  explicit CharacterCode(const CharacterFormat& format);

  const CharacterFormat& format() const { return format_; }
  // Levels per bit that `append` writes: 1, with one and a half stop bits 2.
  static unsigned levels_per_bit(const CharacterFormat& format) {
    return format.stop_bits == StopBits::one_and_a_half ? 2 : 1;
  }
  unsigned levels_per_bit() const { return levels_per_bit(format_); }
  unsigned levels_per_character() const { return format_.half_bits() * levels_per_bit() / 2; }

  // Bits of `data` above the data bits are ignored.
  void append(Levels& levels, unsigned data) const;
  bool parity_bit(unsigned data) const { return parity_bits_.at(data & data_mask_); }

  // The character in sampled bits, the start bit in bit 0.
  Character from_bits(std::uint32_t bits) const {
    Character character;
    character.data = static_cast<std::uint16_t>((bits >> 1) & data_mask_);
    const std::uint32_t parity = parity_bits_[character.data] ? 1 : 0;
    character.is_parity_wrong = (((bits >> (front_ - 1)) ^ parity) & parity_mask_) != 0;
    character.is_stop_missing = ((bits >> front_) & 1) == 0;
    character.is_break = (bits & ((2U << front_) - 1)) == 0;
    return character;
  }

  // Calls sink(character) for each character in levels that are exactly bit-wide, from level `at` on; gives
  // the start of a character that is cut by the end of the levels, or size().
  template <typename Sink>
  std::size_t decode(const Levels& levels, std::size_t at, Sink&& sink) const {
    const std::size_t size = levels.size();
    const unsigned length = front_ + 1;
    while (at < size) {
      std::uint64_t window = levels.window(at);
      if ((window & 1) != 0) {  // idle in front of the start bit
        const auto idle = static_cast<unsigned>(std::countr_one(window));
        at += idle;
        if (idle > 64 - length) continue;
        window >>= idle;
      }
      if (at + length > size) return at < size ? at : size;
      Character character = from_bits(static_cast<std::uint32_t>(window));
      character.level = static_cast<std::uint32_t>(at);
      sink(character);
      at += length;
      if (character.is_stop_missing) {
        while (at < size && !levels[at]) ++at;
      }
    }
    return size;
  }

 private:
  CharacterFormat format_;
  unsigned front_;  // bits in front of the stop bit
  unsigned data_mask_;
  unsigned parity_mask_;  // 0 without parity, else 1
  std::array<bool, 512> parity_bits_{};
};

// A receiver for waveforms of any rate. It starts idle with each waveform: a character does not go on from
// one waveform into the next.
class CharacterReceiver {
 public:
  struct Received {
    Character character;
    kernel::Time start;  // the edge of its start bit
    kernel::Time end;    // when its stop bit has been sampled: before that nobody knows it
    // The end of its last bit by the clock of the receiver; with the stop bit missing, when the line is idle
    // again, or the end of the waveform. Silence is counted from here.
    kernel::Time busy_until;
  };

  CharacterReceiver(const CharacterFormat& format, std::int64_t bit_rate, Sampling sampling = {})
      : code_(format), bit_rate_(bit_rate), sampling_(sampling), sampler_(sampling, bit_rate) {}

  // Appends the characters in order. One that is cut by the end of the waveform is completed with idle line.
  void receive(const Waveform& wave, std::vector<Received>& received);

 private:
  kernel::Time busy_until(const Waveform& wave, const Received& received) const;

  CharacterCode code_;
  std::int64_t bit_rate_;
  Sampling sampling_;
  Sampler sampler_;
};

}  // namespace fieldproof::line
