// The undetected errors of a block check by trying them, beside the exact numbers of block_check.
//
// A frame with a right check is written down, one pattern of flips after the other is laid over it, and what
// comes out is looked at by the rule alone: the exclusive or of all octets is 0 and each parity bit is right.
// Nothing here knows a code, a column or that the answer is the same for every frame.
//
// Limits: frames of up to 63 bits (7 octets with or without parity) and kMostPatterns patterns. A pattern
// costs about 2 ns.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "emc/residual/block_check.hpp"

namespace fieldproof::emc {

constexpr std::uint64_t kMostPatterns = std::uint64_t{1} << 32;

// By the number of flips, 0 to `most_flips`, how many patterns pass. The octets in front of the check are
// those of `message`, zeros where it is empty. A frame or a number of patterns beyond the limits, and a
// message of another length, are a kernel::Error (usage).
std::vector<std::uint64_t> count_block_check_patterns(const BlockCheck& check, unsigned most_flips,
                                                      std::span<const std::uint8_t> message = {});

struct CountedBursts {
  std::uint64_t patterns = 0;
  std::uint64_t undetected = 0;
};

// Bursts of this length: the first and the last of so many neighbouring bits are flipped, and any of those
// between; all of them, at every place of the frame. The bits of a character follow each other from the
// lowest on, its parity last, and the characters too: start and stop bits are left out. `length` is 1 to the
// number of bits.
CountedBursts count_block_check_bursts(const BlockCheck& check, unsigned length,
                                       std::span<const std::uint8_t> message = {});

}  // namespace fieldproof::emc
