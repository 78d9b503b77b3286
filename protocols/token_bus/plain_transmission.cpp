#include "protocols/token_bus/plain_transmission.hpp"

#include "protocols/token_bus/line_code.hpp"

namespace fieldproof::token_bus {
namespace {

constexpr std::size_t kHalfBitsOfSymbol = 4;
constexpr std::size_t kSymbols = 8;  // of an octet, and of a delimiter
constexpr std::size_t kHalfBits = kSymbols * kHalfBitsOfSymbol;
constexpr std::size_t kLeastPreamble = 2 * kHalfBitsOfSymbol;  // two ones lock the decoder

std::uint32_t eight_symbols(const line::Levels& half_bits, std::size_t at) {
  return static_cast<std::uint32_t>(half_bits.window(at));
}

std::uint32_t pattern_of(const MacSymbols& symbols) {
  return eight_symbols(half_bits_of(symbols), 0);
}

struct Patterns {
  std::uint32_t ones = pattern_of(MacSymbols(kSymbols, MacSymbol::one));
  std::uint32_t start = pattern_of(start_delimiter());
  std::uint32_t end = pattern_of(end_delimiter(false, false));
  std::uint32_t more_follows = pattern_of(end_delimiter(true, false)) ^ end;
  std::uint32_t has_error = pattern_of(end_delimiter(false, true)) ^ end;
};

const Patterns& patterns() {
  static const Patterns all;
  return all;
}

// A one and a zero differ in each of their four half bits.
constexpr std::uint32_t kFirstHalfBits = 0x1111'1111;

std::optional<std::uint8_t> octet_of(std::uint32_t half_bits) {
  const std::uint32_t zeros = half_bits ^ patterns().ones;
  std::uint32_t bits = zeros & kFirstHalfBits;
  if (bits * 0xF != zeros) return std::nullopt;
  bits = (bits | bits >> 3) & 0x0303'0303;
  bits = (bits | bits >> 6) & 0x000F'000F;
  return static_cast<std::uint8_t>(~(bits | bits >> 12));
}

// Where the ones in front end; nothing where they do not begin the transmission.
std::optional<std::size_t> end_of_preamble(const line::Levels& half_bits) {
  const std::uint32_t one = patterns().ones & 0xFU;
  std::size_t at = 0;
  while (at + kHalfBits <= half_bits.size() && eight_symbols(half_bits, at) == patterns().ones)
    at += kHalfBits;
  while (at < half_bits.size() && (eight_symbols(half_bits, at) & 0xFU) == one) at += kHalfBitsOfSymbol;
  if (at < kLeastPreamble) return std::nullopt;
  return at;
}

}  // namespace

std::optional<PlainTransmission> plain_transmission_in(const line::Levels& half_bits) {
  const auto start = end_of_preamble(half_bits);
  if (!start || *start + 2 * kHalfBits > half_bits.size()) return std::nullopt;
  if ((half_bits.size() - *start) % kHalfBits != 0 || eight_symbols(half_bits, *start) != patterns().start)
    return std::nullopt;
  PlainTransmission plain{.first_half_bit = *start};
  const std::size_t end = half_bits.size() - kHalfBits;
  plain.octets.reserve((end - *start) / kHalfBits);
  for (std::size_t at = *start + kHalfBits; at < end; at += kHalfBits) {
    const auto octet = octet_of(eight_symbols(half_bits, at));
    if (!octet) return std::nullopt;
    plain.octets.push_back(*octet);
  }
  const std::uint32_t flags = eight_symbols(half_bits, end) ^ patterns().end;
  if ((flags & ~(patterns().more_follows | patterns().has_error)) != 0) return std::nullopt;
  plain.more_follows = (flags & patterns().more_follows) == patterns().more_follows;
  plain.has_error = (flags & patterns().has_error) == patterns().has_error;
  // Half of a symbol is none.
  const std::uint32_t known =
      (plain.more_follows ? patterns().more_follows : 0) | (plain.has_error ? patterns().has_error : 0);
  if (flags != known) return std::nullopt;
  return plain;
}

}  // namespace fieldproof::token_bus
