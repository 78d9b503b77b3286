#include "harness/line/uart.hpp"

#include "harness/kernel/check.hpp"

namespace fieldproof::line {

CharacterFormat Uart::eight_bit_format() const {
  if (format.data_bits <= 8) return format;
  FIELDPROOF_CHECK(format.parity == Parity::none, "a ninth bit takes the place of the parity bit");
  CharacterFormat eight = format;
  eight.data_bits = 8;
  eight.parity = (upper_data_bits & 0x100) != 0 ? Parity::mark : Parity::space;
  return eight;
}

}  // namespace fieldproof::line
