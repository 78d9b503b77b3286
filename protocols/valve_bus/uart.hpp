#pragma once

#include "harness/iut/uart_line.hpp"
#include "protocols/valve_bus/rules.hpp"

// The valve bus on a real serial line.
namespace fieldproof::valve_bus {

inline iut::UartLine uart_line(const Rules& rules) {
  return {uart(rules), delimiter(rules)};
}
// Of a host, which waits for responses.
inline iut::UartLine asking_uart_line(const Rules& rules) {
  return {uart(rules), delimiter(rules), response_time_out(rules)};
}

}  // namespace fieldproof::valve_bus
