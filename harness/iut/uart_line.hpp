#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "harness/iut/device.hpp"
#include "harness/line/character.hpp"

// How the characters of a role go over a real serial line, and what bench and box tell each other of it
// through the channel of the upper tester: what the system between them has delayed. Instants there are those
// of the machine's monotonic clock, counted from the setting kClockOrigin.
namespace fieldproof::iut {

struct UartLine {
  std::int64_t bit_rate = 0;
  line::CharacterFormat on_wire{};      // with all data bits of a character
  line::CharacterFormat of_uart{};      // as a UART of eight data bits has it
  std::uint16_t upper_data_bits = 0;    // of each character, above the octet of the UART
  kernel::Duration shortest_silence{};  // between two frames; a shorter gap cannot be driven
  kernel::Duration end_notice{};        // silence after which nothing more belongs to what was sent

  kernel::Duration character_time() const {
    return kernel::level_time(kernel::kStart, on_wire.half_bits(), 2 * bit_rate) - kernel::kStart;
  }
  std::uint16_t character_of(std::uint8_t octet) const {
    return static_cast<std::uint16_t>(octet | upper_data_bits);
  }
};

// Characters without a gap on such a line, and the driver around them.
struct UartTransmission {
  kernel::Time driver_on{};
  kernel::Time start{};  // of the first start bit
  kernel::Time driver_off{};
  std::vector<std::uint16_t> characters;
};

// Of the settings of a case.
using MakeUartLine = UartLine (*)(const CaseBegin& begin);

// A setting of `case_begin`: nanoseconds of the monotonic clock at which the case has begun.
inline constexpr std::string_view kClockOrigin = "clock_origin_ns";

// Written by the box: how many octets it has received since the case began; when: the end of the last one.
inline constexpr Item kReceivedOctets = 0xFF00;
// Written by the box after each `characters` and the driver around them: how many octets it has put on the
// line since the case began; when: the system had taken the last one.
inline constexpr Item kSentOctets = 0xFF01;

}  // namespace fieldproof::iut
