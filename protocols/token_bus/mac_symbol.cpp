#include "protocols/token_bus/mac_symbol.hpp"

#include "harness/kernel/check.hpp"

namespace fieldproof::token_bus {
namespace {

using enum MacSymbol;

constexpr std::string_view kLetters = "SP01NB";  // in the order of the enumeration

}  // namespace

std::string_view text_of(MacSymbol symbol) {
  switch (symbol) {
    case silence:
      return "silence";
    case pad_idle:
      return "pad_idle";
    case zero:
      return "zero";
    case one:
      return "one";
    case non_data:
      return "non_data";
    case bad_signal:
      return "bad_signal";
  }
  return "";
}

std::string written(std::span<const MacSymbol> symbols) {
  std::string text;
  for (const MacSymbol symbol : symbols) text += kLetters[static_cast<std::size_t>(symbol)];
  return text;
}

MacSymbols mac_symbols_of(std::string_view text) {
  MacSymbols symbols;
  for (const char letter : text) {
    if (letter == ' ') continue;
    const std::size_t place = kLetters.find(letter);
    FIELDPROOF_CHECK(place != std::string_view::npos, "each letter is a MAC symbol");
    symbols.push_back(static_cast<MacSymbol>(place));
  }
  return symbols;
}

MacSymbols start_delimiter() {
  return {non_data, non_data, zero, non_data, non_data, zero, zero, zero};
}

MacSymbols end_delimiter(bool more_follows, bool has_error) {
  return {
      non_data, non_data, one, non_data, non_data, one, more_follows ? one : zero, has_error ? one : zero};
}

void LastFrameEnd::take(MacSymbol symbol) {
  constexpr std::uint64_t kEight = 077'777'777;
  symbols_ = (symbols_ << 3 | static_cast<std::uint64_t>(symbol)) & kEight;
}

bool LastFrameEnd::is_seen() const {
  // N N 1 N N 1 0, and E.
  constexpr std::uint64_t kEnd = 044'344'320;
  constexpr std::uint64_t kAllButE = 077'777'770;
  return (symbols_ & kAllButE) == kEnd;
}

void append_octet(MacSymbols& symbols, std::uint8_t octet) {
  for (unsigned bit = 0; bit < 8; ++bit) symbols.push_back((octet >> bit & 1) != 0 ? one : zero);
}

}  // namespace fieldproof::token_bus
