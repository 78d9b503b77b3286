#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/line/waveform.hpp"

// The transmission that nearly all are: one frame, written as it is sent, and nothing lost or added on its
// way. It is read an octet at a time, where the decoder takes bit by bit; each station of a ring reads each
// frame.
namespace fieldproof::token_bus {

struct PlainTransmission {
  std::vector<std::uint8_t> octets{};  // between the delimiters
  bool more_follows = false;           // I
  bool has_error = false;              // E
  std::size_t first_half_bit = 0;      // of the start delimiter
};

// Nothing where the half bits are not a preamble of two symbols or more, a start delimiter, whole octets and
// an end delimiter, and then end: that is for the decoder.
std::optional<PlainTransmission> plain_transmission_in(const line::Levels& half_bits);

}  // namespace fieldproof::token_bus
