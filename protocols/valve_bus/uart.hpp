#pragma once

#include "harness/iut/uart_line.hpp"
#include "protocols/valve_bus/rules.hpp"

// The characters of the valve bus as a UART of eight data bits sends them: a ninth bit of 1 is a parity bit
// that is always 1.
namespace fieldproof::valve_bus {

inline iut::UartLine uart_line(const Rules& rules) {
  const bool has_ninth_bit = rules.characters == CharacterProfile::ninth_bit_one;
  iut::UartLine uart;
  uart.bit_rate = rules.bit_rate;
  uart.on_wire = uart.of_uart = character_format(rules);
  if (has_ninth_bit) {
    uart.of_uart.data_bits = 8;
    uart.of_uart.parity = line::Parity::mark;
    uart.upper_data_bits = 0x100;
  }
  uart.shortest_silence = delimiter(rules);
  uart.end_notice = character_notice(rules);
  return uart;
}

}  // namespace fieldproof::valve_bus
