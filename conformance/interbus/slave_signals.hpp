#pragma once

#include <cstdint>

#include "harness/kernel/time.hpp"

// Inputs that show when they were looked at.
namespace fieldproof::conformance {

// They jump between 0000h and FFFFh at instants that have nothing to do with the cycle.
inline std::uint16_t jumping(kernel::Time when, std::uint64_t seed) {
  constexpr std::int64_t kPiece = 7'300'000;  // ps
  std::uint64_t mixed = static_cast<std::uint64_t>(when.time_since_epoch().count() / kPiece) + seed;
  mixed = (mixed ^ mixed >> 31) * 0x9E3779B97F4A7C15U;
  return (mixed >> 40 & 1U) != 0 ? 0xFFFF : 0x0000;
}

// A clock at the terminals: tells when it was looked at, in microseconds.
inline std::uint16_t clock_word(kernel::Time when) {
  return static_cast<std::uint16_t>(when.time_since_epoch().count() / 1'000'000 & 0xFFFF);
}

}  // namespace fieldproof::conformance
