// What a frame check cannot see: error patterns that are code words of its polynomial.
//
// A pattern of flipped bits in a message and its check goes undetected exactly when the polynomial divides
// it; initial register and final XOR play no part. Bit positions count from the first bit of the code word in
// line order, so the last `width` positions are the check. For octets that go least significant bit first,
// position 8 k + b is bit b of octet k, for the others bit 7 - b.
//
// Limits: widths to 64. The lists are made by joining pairs of positions: memory and time grow with the
// square of the length, and the result grows with its fourth power (about bits^4 / 24 / 2^(width - 1)): meant
// for code words up to some 600 bits.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "harness/line/frame_check.hpp"

namespace fieldproof::line {

// Four positions in ascending order.
using FourBits = std::array<std::uint32_t, 4>;

// All undetected patterns of exactly four flipped bits in code words of that length, in ascending order.
std::vector<FourBits> weight_four_code_words(const FrameCheckParameters& parameters, unsigned codeword_bits);

// True when some pattern of one to `weight` flipped bits goes undetected in code words of that length: the
// Hamming distance there is at most `weight`. Costs about bits^((weight - 1) / 2) steps, rounded up; `weight`
// is at least 1.
bool has_code_word(const FrameCheckParameters& parameters, unsigned codeword_bits, unsigned weight);

// The remainder of x^exponent, in the orientation of the polynomial.
std::uint64_t power_of_x(const FrameCheckParameters& parameters, std::uint64_t exponent);

}  // namespace fieldproof::line
