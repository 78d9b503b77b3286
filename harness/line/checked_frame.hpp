#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "harness/line/delimited_frame.hpp"

// Frames of IEC 61158-2 whose octets end with a frame check: CRC-16/PROFIBUS, the high octet first
// [searched].
namespace fieldproof::line {

inline constexpr std::size_t kFrameCheckOctets = 2;

// The octets with their check after them.
std::vector<std::uint8_t> with_frame_check(std::span<const std::uint8_t> octets);

// What the whole frames of a transmission carry whose check fits, without the check.
std::vector<std::vector<std::uint8_t>> checked_frames_in(const Waveform& wave, std::int64_t bit_rate);

}  // namespace fieldproof::line
