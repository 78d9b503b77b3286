// How many words of each weight the dual of a frame check has: all that its undetected errors depend on.
//
// A pattern of flips goes undetected when r parities of it are even, r the width of the check. The 2^r sums
// of these parities are words of as many bits as the telegram: windows of that length on the sequences of the
// register that has the check's polynomial. So each cycle of that register is walked once with a window that
// sheds one bit and takes one; that gives the weights of all 2^r words, exactly, at the price of some steps
// each instead of a pass over the telegram. Words of 64 bits are taken at a time: the polynomial of the 64th
// power has the same taps, 64 places apart.
//
// Limits: widths 3 to 32, up to kMostBits bits. A 32-bit check takes seconds, checks up to 16 bits well under
// a millisecond. `count` includes words that are equal, which happens when there are fewer bits than the
// width: every use below counts them the same way.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "harness/line/frame_check.hpp"

namespace fieldproof::emc {

constexpr unsigned kWidestCheck = 32;
constexpr unsigned kMostBits = 1U << 17;

struct DualWeights {
  unsigned width = 0;
  unsigned bits = 0;                 // message and check
  std::vector<std::uint64_t> count;  // by weight, 0 to `bits`; the sum is 2^width
};

// Told now and then how many words are weighed.
using DualProgress = std::function<void(std::uint64_t done)>;

// How many words dual_weights() weighs for this check, for a progress bar.
std::uint64_t words_to_weigh(const line::FrameCheckParameters& parameters);

// A width or length outside the limits is a kernel::Error (usage).
DualWeights dual_weights(const line::FrameCheckParameters& parameters, unsigned bits,
                         const DualProgress& on_progress = {});

}  // namespace fieldproof::emc
