#include "harness/line/manchester.hpp"

namespace fieldproof::line {

ManchesterCode::ManchesterCode(const ManchesterLayout& layout) : one_falls_(layout.one_falls) {
  for (const Symbol symbol : {Symbol::zero, Symbol::one, Symbol::non_data_plus, Symbol::non_data_minus}) {
    symbols_.at(halves_of(symbol)) = symbol;
  }
  for (unsigned octet = 0; octet < octets_.size(); ++octet) {
    std::uint64_t levels = 0;
    for (unsigned bit = 0; bit < 8; ++bit) {
      const bool is_one = (octet >> (layout.most_significant_first ? 7 - bit : bit) & 1) != 0;
      levels |= halves_of(is_one ? Symbol::one : Symbol::zero) << (2 * bit);
    }
    octets_.at(octet) = static_cast<std::uint16_t>(levels);
  }
}

// The first half in bit 0.
std::uint64_t ManchesterCode::halves_of(Symbol symbol) const {
  constexpr std::uint64_t kFalls = 0b01;
  constexpr std::uint64_t kRises = 0b10;
  switch (symbol) {
    case Symbol::zero:
      return one_falls_ ? kRises : kFalls;
    case Symbol::one:
      return one_falls_ ? kFalls : kRises;
    case Symbol::non_data_plus:
      return 0b11;
    case Symbol::non_data_minus:
      return 0b00;
  }
  return 0;
}

void ManchesterReceiver::receive(const Waveform& wave, std::vector<Symbol>& symbols) const {
  __extension__ using Wide = unsigned __int128;
  const auto rate = static_cast<std::uint64_t>(wave.rate);
  const auto quarter_rate = static_cast<std::uint64_t>(bit_rate_) * 4;
  const auto level_in = [&](std::uint64_t quarters) {
    return wave.levels[static_cast<std::size_t>(Wide{quarters} * rate / quarter_rate)];
  };
  const auto bits = static_cast<std::uint64_t>(Wide{wave.levels.size()} * (quarter_rate / 4) / rate);
  for (std::uint64_t bit = 0; bit < bits; ++bit) {
    symbols.push_back(code_.symbol_of(level_in(4 * bit + 1), level_in(4 * bit + 3)));
  }
}

}  // namespace fieldproof::line
