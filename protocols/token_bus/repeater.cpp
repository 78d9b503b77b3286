#include "protocols/token_bus/repeater.hpp"

#include <algorithm>

#include "protocols/token_bus/line_code.hpp"

namespace fieldproof::token_bus {
namespace {

// Of a bit that is `one` or not, the first half in bit 0.
constexpr std::uint64_t half_bits(bool one) {
  return one ? 0b10 : 0b01;
}

// How many bits of a preamble come, with the two ones that end it; nothing where none ends.
std::optional<std::size_t> preamble_in(const std::vector<ReceivedBit>& bits) {
  for (std::size_t n = 1; n < bits.size(); ++n) {
    const bool is_data = bits[n].symbol != PhySymbol::idl && bits[n - 1].symbol != PhySymbol::idl;
    if (!is_data || bits[n].status.has_signal_error || bits[n - 1].status.has_signal_error)
      return std::nullopt;
    if (bits[n].symbol != bits[n - 1].symbol) continue;
    return bits[n].symbol == PhySymbol::cd1 ? std::optional(n + 1) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

void Divider::hear(Side side, segment::MediumPort& place, kernel::Duration distance) {
  place.tap_driven(ears_.emplace_back(*this, *ports_[side == Side::left ? 1 : 0], distance));
}

// What of it comes while the cable is whole.
void Joint::pass(const line::Waveform& wave, segment::MediumPort& to) {
  std::size_t begin = 0;
  const auto drive_up_to = [&](std::size_t end) {
    if (end <= begin) return;
    line::Waveform part{wave.time_of(begin), wave.rate, wave.levels.slice(begin, end - begin)};
    to.drive(part);
  };
  for (const Cut& cut : cuts_) {
    drive_up_to(wave.first_level_at(cut.from));
    begin = std::max(begin, wave.first_level_at(cut.to));
  }
  drive_up_to(wave.levels.size());
}

void Repeater::pass(const line::Waveform& wave, segment::MediumPort& to) {
  const kernel::Duration delay = kernel::levels_duration(cable_.repeater_delay_bits, rules_.phy_bit_rate);
  line::Waveform out{wave.start + delay, 2 * rules_.phy_bit_rate, repeated(wave)};
  to.drive(out);
}

line::Levels Repeater::repeated(const line::Waveform& wave) const {
  std::size_t first = 0;
  const std::vector<ReceivedBit> bits = received_bits(wave, rules_.phy_bit_rate, &first);
  const line::Levels came = line::half_bits_of(wave, rules_.phy_bit_rate);
  line::Levels out;
  const auto preamble = preamble_in(bits);
  if (preamble) {
    // A one and a zero by turns, and a one more at its end.
    const std::size_t count = std::max<std::size_t>(*preamble, cable_.repeater_preamble_bits);
    for (std::size_t n = 0; n < count; ++n) out.append(half_bits((count - n) % 2 == 0 || n + 1 == count), 2);
    const std::size_t rest = first + 2 * *preamble;
    out.append(came.slice(rest, came.size() - std::min(rest, came.size())));
  } else {
    out = came;
  }
  if (out.size() % 2 != 0) out.append_idle(1);
  while (out.size() < std::size_t{2} * cable_.least_fragment_bits)
    out.append(half_bits(out.size() % 4 == 0), 2);
  const auto most = static_cast<std::size_t>(kernel::levels_within(cable_.jabber, 2 * rules_.phy_bit_rate));
  return out.size() > most ? out.slice(0, most) : out;
}

}  // namespace fieldproof::token_bus
