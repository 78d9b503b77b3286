#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// What the MAC of IEEE 802.4 and a physical layer give each other, symbol by symbol. A station requests
// silence, pad_idle, zero, one and non_data; it is indicated silence, bad_signal, zero, one and non_data: a
// preamble arrives as ones.
namespace fieldproof::token_bus {

enum class MacSymbol : std::uint8_t { silence, pad_idle, zero, one, non_data, bad_signal };

using MacSymbols = std::vector<MacSymbol>;

inline bool is_data(MacSymbol symbol) {
  return symbol == MacSymbol::zero || symbol == MacSymbol::one;
}

// "non_data".
std::string_view text_of(MacSymbol symbol);

// One letter each, as the standard writes delimiters: N N 0 N N 0 0 0. Silence is S, pad_idle P, bad_signal
// B.
std::string written(std::span<const MacSymbol> symbols);
// The other way round; blanks separate. A letter that is none is a broken invariant.
MacSymbols mac_symbols_of(std::string_view text);

// The start delimiter, and the end delimiter with its two bits: I, more frames follow in this transmission;
// E, an error was noticed on the way.
MacSymbols start_delimiter();
MacSymbols end_delimiter(bool more_follows, bool has_error);
// Watches symbols for the end delimiter after which nothing follows: I is 0.
class LastFrameEnd {
 public:
  void take(MacSymbol symbol);
  // It was complete with the last symbol.
  bool is_seen() const;

 private:
  std::uint64_t symbols_ = 0;  // the last eight, three bits each, the last one lowest
};
// Octets go least significant bit first.
void append_octet(MacSymbols& symbols, std::uint8_t octet);

}  // namespace fieldproof::token_bus
