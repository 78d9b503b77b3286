#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

// The two frames of the valve bus and their block check.
//
//   command, host to node:   ID  COMMAND  DATA0  DATA1  BCC      BCC = ID ^ COMMAND ^ DATA0 ^ DATA1
//   response, node to host:  DATA0  DATA1  BCC                   BCC = DATA0 ^ DATA1
//
// No delimiter, no length and, in the response, no address: what a frame is, only the silence around it says
// (see codec.hpp).
namespace fieldproof::valve_bus {

inline constexpr std::size_t kCommandOctets = 5;
inline constexpr std::size_t kResponseOctets = 3;

struct Command {
  std::uint8_t id = 0;
  std::uint8_t command = 0;
  std::uint8_t data0 = 0;
  std::uint8_t data1 = 0;

  friend bool operator==(const Command&, const Command&) = default;
};

struct Response {
  std::uint8_t data0 = 0;
  std::uint8_t data1 = 0;

  friend bool operator==(const Response&, const Response&) = default;
};

// The exclusive or of the octets; 0 over a frame with its check.
std::uint8_t block_check(std::span<const std::uint8_t> octets);

std::array<std::uint8_t, kCommandOctets> octets_of(const Command& command);
std::array<std::uint8_t, kResponseOctets> octets_of(const Response& response);

// "write 05: A5 3C", "read 63", "command 07 of 05: 00 00"; "response F0 0F".
std::string describe(const Command& command);
std::string describe(const Response& response);

}  // namespace fieldproof::valve_bus
