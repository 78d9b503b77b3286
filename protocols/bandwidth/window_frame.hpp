#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "harness/kernel/time.hpp"
#include "protocols/bandwidth/window_server.hpp"

// The frames of a line on which the server visits nodes, without the frame check that the line adds. The
// paper adds one octet to the frame control of the server and names no frame; these are this project's.
//
//   token, poll   0000 0001 / 0000 0010   destination, PB
//   answer        0000 0011               source, PB
//   data          0001 00KK               destination, source, PB, data; KK: real-time, periodic,
//   non-real-time
//
// A periodic datum carries when it was sampled and from which sample of the sensor it comes, in picoseconds.
namespace fieldproof::bandwidth {

using Octets = std::vector<std::uint8_t>;

enum class FrameType : std::uint8_t { token, poll, answer, data };

struct WindowFrame {
  FrameType type = FrameType::token;
  Packet packet = Packet::none;  // of data
  std::uint8_t destination = 0;  // of all but answers
  std::uint8_t source = 0;       // of answers and data
  PeriodicByte byte{};
  kernel::Time generated{};  // of periodic data
  kernel::Time sample{};

  friend bool operator==(const WindowFrame&, const WindowFrame&) = default;
};

inline constexpr std::size_t kServerOctets = 3;
inline constexpr std::size_t kDataHeaderOctets = 4;
inline constexpr std::size_t kDatumOctets = 16;

// `data_octets` of data, at least kDatumOctets for periodic ones.
Octets octets_of(const WindowFrame& frame, std::size_t data_octets);
// Nothing when they are no frame: an unknown type, a length or an address that does not fit.
std::optional<WindowFrame> window_frame_of(std::span<const std::uint8_t> octets);

}  // namespace fieldproof::bandwidth
