#include "protocols/valve_bus/rules.hpp"

#include <algorithm>
#include <array>

namespace fieldproof::valve_bus {
line::CharacterFormat character_format(const Rules& rules) {
  line::CharacterFormat format;
  if (rules.characters == CharacterProfile::ninth_bit_one) format.data_bits = 9;
  if (rules.characters == CharacterProfile::even_parity) format.parity = line::Parity::even;
  return format;
}

line::Uart uart(const Rules& rules) {
  const bool has_ninth_bit = rules.characters == CharacterProfile::ninth_bit_one;
  return {rules.bit_rate, character_format(rules), static_cast<std::uint16_t>(has_ninth_bit ? 0x100 : 0)};
}

std::string_view text_of(CharacterProfile profile) {
  switch (profile) {
    case CharacterProfile::ninth_bit_one:
      return "P0";
    case CharacterProfile::even_parity:
      return "P1";
    case CharacterProfile::eight_bits:
      return "P2";
  }
  return "";
}

kernel::Duration turnaround_time_span(const Rules& rules) {
  return std::max(rules.turnaround_time_span, 2 * character_notice(rules));
}

kernel::Duration actuation_limit(const Rules& rules) {
  return std::max(rules.actuation_limit, 2 * character_notice(rules));
}

kernel::Duration response_time_out(const Rules& rules) {
  return delimiter(rules) +
         std::max(rules.response_wait, turnaround_time_span(rules) + character_notice(rules));
}

std::span<const std::int64_t> dip_bit_rates() {
  // 12 MHz / 32 and / 64 (mode 2), then 12 MHz / (12 * 16 * n) and / (12 * 32 * n) with n = 1, 1, 3, 3,
  // 13, 13.
  static constexpr std::array<std::int64_t, 8> kRates{375'000, 187'500, 62'500, 31'250,
                                                      20'833,  10'417,  4'808,  2'404};
  return kRates;
}

}  // namespace fieldproof::valve_bus
