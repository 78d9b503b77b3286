#include "harness/line/delimited_frame.hpp"
#include "protocols/token_bus/frame.hpp"
#include "protocols/token_bus/plain_transmission.hpp"

namespace fieldproof::token_bus {
namespace {

constexpr std::size_t kDelimiterSymbols = 8;
// Where the four non_data of a delimiter lie, and what makes it the start.
constexpr std::size_t kMarkAt = 2;

using Indications = std::span<const Indication>;

bool is_delimiter(Indications indications, std::size_t at, MacSymbol mark) {
  if (at + kDelimiterSymbols > indications.size()) return false;
  for (std::size_t n = 0; n < 6; ++n) {
    const MacSymbol due = n % 3 == kMarkAt ? mark : MacSymbol::non_data;
    if (indications[at + n].symbol != due) return false;
  }
  return true;
}

bool is_start(Indications indications, std::size_t at) {
  return is_delimiter(indications, at, MacSymbol::zero) && indications[at + 6].symbol == MacSymbol::zero &&
         indications[at + 7].symbol == MacSymbol::zero;
}

bool is_end(Indications indications, std::size_t at) {
  return is_delimiter(indications, at, MacSymbol::one) && is_data(indications[at + 6].symbol) &&
         is_data(indications[at + 7].symbol);
}

std::size_t half_bit_at(Indications indications, std::size_t at) {
  if (at < indications.size()) return indications[at].half_bit;
  constexpr std::size_t kHalfBitsOfSymbol = 4;
  return indications.empty() ? 0 : indications.back().half_bit + kHalfBitsOfSymbol;
}

}  // namespace

std::vector<Reception> FrameReader::read(const line::Waveform& wave) const {
  const line::Levels half_bits = line::half_bits_of(wave, rules_.phy_bit_rate);
  const auto plain = plain_transmission_in(half_bits);
  if (!plain) return read(indications_in(wave, rules_.phy_bit_rate));
  Reception reception{.octets = plain->octets,
                      .more_follows = plain->more_follows,
                      .first_half_bit = plain->first_half_bit,
                      .end_half_bit = half_bits.size()};
  close(reception, plain->has_error);
  return {reception};
}

std::vector<Reception> FrameReader::read(Indications indications) const {
  std::vector<Reception> receptions;
  for (std::size_t at = 0; at + kDelimiterSymbols <= indications.size();) {
    if (!is_start(indications, at)) {
      ++at;
      continue;
    }
    Reception& reception = receptions.emplace_back();
    reception.first_half_bit = indications[at].half_bit;
    at = read_one(indications, at + kDelimiterSymbols, reception);
    reception.end_half_bit = half_bit_at(indications, at);
  }
  if (receptions.empty()) {
    receptions.push_back({.end_half_bit = half_bit_at(indications, indications.size())});
  }
  return receptions;
}

// Returns where to look for the next one.
std::size_t FrameReader::read_one(Indications indications, std::size_t at, Reception& reception) const {
  unsigned bits = 0;
  unsigned octet = 0;
  for (; at < indications.size(); ++at) {
    const MacSymbol symbol = indications[at].symbol;
    if (!is_data(symbol)) break;
    octet |= (symbol == MacSymbol::one ? 1U : 0U) << bits;
    if (++bits < 8) continue;
    reception.octets.push_back(static_cast<std::uint8_t>(octet));
    bits = octet = 0;
  }
  reception.kind = is_too_long(reception.octets.size()) ? ReceptionKind::too_long : ReceptionKind::fragment;
  if (!is_end(indications, at)) return is_start(indications, at) ? at : at + 1;
  reception.more_follows = indications[at + 6].symbol == MacSymbol::one;
  if (bits == 0) close(reception, indications[at + 7].symbol == MacSymbol::one);
  return at + kDelimiterSymbols;
}

// What stands between both delimiters.
void FrameReader::close(Reception& reception, bool has_error) const {
  const std::size_t least = frame_octets(rules_, 0);
  if (is_too_long(reception.octets.size())) {
    reception.kind = ReceptionKind::too_long;
  } else if (has_error && counts_error_bit()) {
    reception.kind = ReceptionKind::e_bit_error;
  } else if (reception.octets.empty()) {
    reception.kind = ReceptionKind::fragment;  // an abort sequence
  } else if (!is_check_right(reception.octets)) {
    reception.kind = ReceptionKind::fcs_error;
  } else if (reception.octets.size() < least) {
    reception.kind = ReceptionKind::fragment;
  } else {
    reception.kind = ReceptionKind::frame;
    reception.octets.resize(reception.octets.size() - kCheckOctets);
  }
}

}  // namespace fieldproof::token_bus
