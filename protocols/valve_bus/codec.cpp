#include "protocols/valve_bus/codec.hpp"

#include "harness/kernel/check.hpp"

namespace fieldproof::valve_bus {

Command command_of(std::span<const std::uint8_t> octets) {
  FIELDPROOF_CHECK(octets.size() == kCommandOctets, "a command has five octets");
  return {octets[0], octets[1], octets[2], octets[3]};
}

Response response_of(std::span<const std::uint8_t> octets) {
  FIELDPROOF_CHECK(octets.size() == kResponseOctets, "a response has three octets");
  return {octets[0], octets[1]};
}

}  // namespace fieldproof::valve_bus
