#pragma once

#include <string_view>

#include "harness/iut/device.hpp"
#include "protocols/valve_bus/rules.hpp"

// What the upper tester's channel of a node on a real line carries besides valves and switches, so that
// bench and node know of each other what the system between them has delayed. All instants are those of the
// machine's monotonic clock, counted from the setting kClockOrigin.
namespace fieldproof::valve_bus {

// A setting of `case_begin`: nanoseconds of the monotonic clock at which the case has begun.
inline constexpr std::string_view kClockOrigin = "clock_origin_ns";

// Written by the node: how many octets it has heard since the case began; when: the end of the last one.
inline constexpr iut::Item kHeardOctets = 2;
// Written by the node behind each `transmit_characters`: how many octets it has put on the line since the
// case began; when: the system had taken the last one.
inline constexpr iut::Item kSaidOctets = 3;

// The character format of a UART for these characters: a ninth bit of 1 is a parity bit that is always 1.
inline line::CharacterFormat serial_format(const Rules& rules) {
  line::CharacterFormat format = character_format(rules);
  if (rules.characters == CharacterProfile::ninth_bit_one) {
    format.data_bits = 8;
    format.parity = line::Parity::mark;
  }
  return format;
}

}  // namespace fieldproof::valve_bus
