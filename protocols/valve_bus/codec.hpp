#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "harness/line/gap_frame.hpp"
#include "harness/line/uart_codec.hpp"
#include "protocols/valve_bus/frame.hpp"
#include "protocols/valve_bus/rules.hpp"

// Which characters are which frame of the valve bus: silence of at least 3.5 characters ends a frame, a gap
// above 1.5 characters spoils one. How many octets it must have depends on who receives it.
namespace fieldproof::valve_bus {

inline constexpr std::size_t kMostFrameOctets = 8;  // that are kept: no frame is longer
using CollectedFrame = line::GapFrame<kMostFrameOctets>;

class FrameCollector : public line::GapFrameCollector<kMostFrameOctets> {
 public:
  explicit FrameCollector(const Rules& rules) : GapFrameCollector(gaps(rules)) {}
};

class CharacterCodec : public line::UartCodec {
 public:
  explicit CharacterCodec(const Rules& rules) : UartCodec(uart(rules)) {}
};

// The command in five octets, whatever its check is. Four octets, six octets are a broken invariant.
Command command_of(std::span<const std::uint8_t> octets);
Response response_of(std::span<const std::uint8_t> octets);

}  // namespace fieldproof::valve_bus
