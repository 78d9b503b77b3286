#include "protocols/valve_bus/frame.hpp"

#include <fmt/format.h>

#include "protocols/valve_bus/rules.hpp"

namespace fieldproof::valve_bus {

std::uint8_t block_check(std::span<const std::uint8_t> octets) {
  std::uint8_t check = 0;
  for (const std::uint8_t octet : octets) check ^= octet;
  return check;
}

std::array<std::uint8_t, kCommandOctets> octets_of(const Command& command) {
  std::array<std::uint8_t, kCommandOctets> octets{command.id, command.command, command.data0, command.data1,
                                                  0};
  octets.back() = block_check(octets);
  return octets;
}

std::array<std::uint8_t, kResponseOctets> octets_of(const Response& response) {
  std::array<std::uint8_t, kResponseOctets> octets{response.data0, response.data1, 0};
  octets.back() = block_check(octets);
  return octets;
}

std::string describe(const Command& command) {
  constexpr Rules kRules;
  if (command.command == kRules.read_command) return fmt::format("read {:02X}", command.id);
  const std::string data = fmt::format("{:02X} {:02X}", command.data0, command.data1);
  if (command.command == kRules.write_command) return fmt::format("write {:02X}: {}", command.id, data);
  return fmt::format("command {:02X} of {:02X}: {}", command.command, command.id, data);
}

std::string describe(const Response& response) {
  return fmt::format("response {:02X} {:02X}", response.data0, response.data1);
}

}  // namespace fieldproof::valve_bus
