#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "harness/line/telegram.hpp"
#include "harness/line/waveform.hpp"

// What fuzz targets hold the line code and the frame check against: written from their definitions, one level
// and one bit at a time, and sharing no code with what is under test. Not instrumented, because the fuzzer
// shall look for new ways through the subject and not through its measure.
#if defined(__clang__)
#define FIELDPROOF_UNINSTRUMENTED __attribute__((no_sanitize("address", "undefined", "coverage")))
#else
#define FIELDPROOF_UNINSTRUMENTED
#endif

namespace fieldproof::fuzz {

// A telegram and the level of the line with which it begins.
struct HeardTelegram {
  std::size_t level = 0;
  std::uint8_t header = 0;
  std::uint8_t data = 0;
};

// The telegrams of a line of bit-wide levels, idle after its end, under the layout of the rules' defaults.
// Calls sink(HeardTelegram).
template <typename Sink>
FIELDPROOF_UNINSTRUMENTED void hear_bit_by_bit(const line::Levels& levels, Sink&& sink) {
  std::size_t n = 0;
  const std::size_t size = levels.size();
  const std::uint64_t* const words = levels.words();
  const auto at = [&](std::size_t k) FIELDPROOF_UNINSTRUMENTED {
    return k >= size ? 1U : static_cast<unsigned>(words[k / 64] >> (k % 64)) & 1U;
  };
  while (n < size) {
    if (at(n) != 0) {
      ++n;
      continue;
    }
    HeardTelegram telegram{n, static_cast<std::uint8_t>(at(n + 1) | at(n + 2) << 1 | at(n + 3) << 2), 0};
    std::size_t stop = n + 4;
    if (at(n + 3) != 0) {
      for (; stop < n + 12; ++stop) {
        telegram.data = static_cast<std::uint8_t>((telegram.data & 0x7FU) << 1 | at(stop));
      }
    }
    n = stop + 1;
    if (at(stop) == 0) {
      telegram.header |= line::kStopMissing;
      while (n < size && at(n) == 0) ++n;
    }
    sink(telegram);
  }
}

// CRC-16/IBM-3740 by its definition: polynomial 1021h, preset FFFFh, the first bit of an octet is its
// highest.
FIELDPROOF_UNINSTRUMENTED inline std::uint16_t check_bit_by_bit(std::span<const std::uint8_t> octets,
                                                                std::uint16_t state = 0xFFFF) {
  unsigned sum = state;
  const std::uint8_t* const data = octets.data();  // the functions of a span are instrumented
  for (std::size_t n = 0, bits = octets.size() * 8; n < bits; ++n) {
    const unsigned bit = static_cast<unsigned>(data[n / 8] >> (7 - n % 8)) & 1U;
    const unsigned leaves = (sum >> 15 ^ bit) & 1U;
    sum = (sum << 1 ^ (leaves != 0 ? 0x1021U : 0U)) & 0xFFFFU;
  }
  return static_cast<std::uint16_t>(sum);
}

}  // namespace fieldproof::fuzz
