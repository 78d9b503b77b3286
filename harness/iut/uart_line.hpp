#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "harness/iut/device.hpp"
#include "harness/line/uart.hpp"

// How the characters of a role go over a real serial line, and what bench and box tell each other of it
// through the channel of the upper tester: what the system between them has delayed. Instants there are those
// of the machine's monotonic clock, counted from the setting kClockOrigin.
namespace fieldproof::iut {

// The UART of the system has eight data bits: Uart::eight_bit_format.
struct UartLine : line::Uart {
  kernel::Duration shortest_silence{};  // between two frames; a shorter gap cannot be driven
  // Of a box that asks: what begins later after its last stop bit is no answer for it. Zero: it does not ask.
  kernel::Duration latest_answer{};
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
