#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "harness/line/manchester.hpp"

// The frame of IEC 61158-2: a preamble of 1 to 8 octets, a start delimiter, octets with the most significant
// bit first, an end delimiter; all in bi-phase symbols, in which a 1 falls in its middle.
//
// Source of both delimiters and of the symbols: nanoFIP, an open implementation of the physical layer
// [searched]. The octets carry a frame check, which is not looked at here.
namespace fieldproof::line {

inline constexpr unsigned kMostPreambleOctets = 8;

class DelimitedFrameCode {
 public:
  DelimitedFrameCode() : code_(ManchesterLayout{}) {}

  // Levels that are half a bit wide. `preamble_octets` is 1 to kMostPreambleOctets.
  void append(Levels& levels, std::span<const std::uint8_t> octets, unsigned preamble_octets = 1) const;

  // Half bits of all: 16 for each octet of preamble, delimiters and content.
  static constexpr std::size_t levels_of(std::size_t octets, unsigned preamble_octets = 1) {
    return 16 * (octets + preamble_octets + 2);
  }

 private:
  ManchesterCode code_;
};

enum class FrameEnd : std::uint8_t {
  whole,           // by its end delimiter, with whole octets
  code_violation,  // a symbol that is no data, outside of a delimiter
  cut_octet,       // by its end delimiter, behind a part of an octet
  begun_anew,      // by the start delimiter of the next one
  signal_lost      // the transmission ended before
};

// "code violation"
std::string_view text_of(FrameEnd end);

struct DelimitedFrame {
  std::size_t half_bit = 0;  // at which its start delimiter begins, as `half_bits_of` counts
  std::vector<std::uint8_t> octets;
  FrameEnd end = FrameEnd::signal_lost;
};

// The half bits of a transmission, from its first level on. Each edge is a border of half bits, and how many
// lie between two edges is rounded: that recovers the clock, whatever is cut off in front, while two edges
// are less than a quarter of a bit nearer or farther than they should be. Shorter pulses vanish.
Levels half_bits_of(const Waveform& wave, std::int64_t bit_rate);

// All frames of a transmission: what its start delimiters begin. One whose polarity is turned has none, for
// both kinds of symbols that are no data are exchanged.
std::vector<DelimitedFrame> delimited_frames_in(const Waveform& wave, std::int64_t bit_rate);

// The same transmission with its polarity turned, as a device sees it whose two wires are exchanged.
Waveform turned(const Waveform& wave);

}  // namespace fieldproof::line
