#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "harness/line/waveform.hpp"

// The bi-phase line code (Manchester): a symbol is two half-bit levels. The data symbols have an edge in the
// middle of the bit; the two symbols without one are no data, and delimit frames.
//
// Which edge is a 1 differs between standards, so it is a table: IEC 61158-2 has a 1 fall in its middle (as
// an open implementation of WorldFIP has it too), IEEE 802.3 has it rise. Two lines of different kind must
// not share one layout.
//
// Decoding never fails: any two levels are a symbol.
namespace fieldproof::line {

enum class Symbol : std::uint8_t { zero, one, non_data_plus, non_data_minus };

inline bool is_data(Symbol symbol) {
  return symbol == Symbol::zero || symbol == Symbol::one;
}

struct ManchesterLayout {
  bool one_falls = true;  // 1: level 1, then 0; 0: the other way round
  bool most_significant_first = true;

  friend bool operator==(const ManchesterLayout&, const ManchesterLayout&) = default;
};

class ManchesterCode {
 public:
  explicit ManchesterCode(const ManchesterLayout& layout);

  // Levels that are half a bit wide, two for each symbol.
  void append(Levels& levels, Symbol symbol) const { levels.append(halves_of(symbol), 2); }
  void append_octet(Levels& levels, std::uint8_t octet) const { levels.append(octets_[octet], 16); }

  Symbol symbol_of(bool first_half, bool second_half) const {
    return symbols_[static_cast<std::size_t>(first_half) | static_cast<std::size_t>(second_half) << 1];
  }

 private:
  std::uint64_t halves_of(Symbol symbol) const;

  bool one_falls_;
  std::array<Symbol, 4> symbols_{};          // halves, the first in bit 0 -> symbol
  std::array<std::uint16_t, 256> octets_{};  // octet -> 16 levels, the first in bit 0
};

// A receiver that takes each half bit in its middle, at (2 k + 1) / 4 bit times after the begin of the
// transmission, from a waveform of any rate. Nothing is rounded.
//
// Limit: its clock is that of the transmission. How a receiver recovers it from the preamble, and how far it
// strays until the next edge, is not modelled. `bit_rate` is positive and below 2^60 bit/s.
class ManchesterReceiver {
 public:
  ManchesterReceiver(const ManchesterLayout& layout, std::int64_t bit_rate)
      : code_(layout), bit_rate_(bit_rate) {}

  // Appends the symbols of the whole bits of the waveform, in order.
  void receive(const Waveform& wave, std::vector<Symbol>& symbols) const;

 private:
  ManchesterCode code_;
  std::int64_t bit_rate_;
};

}  // namespace fieldproof::line
