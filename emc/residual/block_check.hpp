// The block check that is the exclusive or of the octets before it: which flips it cannot see, exactly.
//
// N octets, the last of them the check; with `has_parity` each of them also carries a parity bit (even or
// odd, the flips that pass are the same). Without it a pattern of flips passes when each of the 8 columns has
// an even number of them: the code with the generator x^8 + 1 over octets. With it each of the N rows of 9
// bits has to be even too; the column of parity bits is then even by itself, and what passes is the product
// of two codes of even weight.
//
// All of it follows from the dual code, which is small enough to be written down. Without parity its words
// are whole columns: C(8, c) of weight c N. With parity they are r rows plus c columns of the N x 9 bits, of
// weight r (9 - c) + c (N - r), each of them twice, because all rows are all columns. So the functions for
// frame checks in weight_distribution and residual_error are those for this check as well; without parity
//   P_ue(p) = ((1 + (1 - 2p)^N) / 2)^8 - (1 - p)^(8N).
//
// Limits: at most kMostOctetsOfBlock octets, with parity kMostOctetsWithParity. Framing is outside of it:
// what breaks a start or stop bit is no pattern here.
#pragma once

#include <vector>

#include "emc/residual/dual_weights.hpp"
#include "emc/residual/weight_distribution.hpp"

namespace fieldproof::emc {

constexpr unsigned kMostOctetsOfBlock = kMostBits / 8;
constexpr unsigned kMostOctetsWithParity = 48;  // the number of words of the dual code fits 64 bits

struct BlockCheck {
  unsigned octets = 0;  // with the check
  bool has_parity = false;

  unsigned bits_per_octet() const { return has_parity ? 9 : 8; }
  unsigned bits() const { return octets * bits_per_octet(); }
};

// No octet, or more of them than the limit, is a kernel::Error (usage). `width` is the number of parities
// that are independent of each other: 8, with parity 8 + N.
DualWeights dual_weights(const BlockCheck& check);

// A_0 to A_up_to: the patterns of k flips that pass; A_0 is 1, the one without a flip. `up_to` is at most the
// number of bits.
std::vector<BigCount> undetected_patterns(const BlockCheck& check, unsigned up_to);

// On a binary symmetric channel, exact to the digits of a double; rates as for frame checks.
double undetected_error_probability(const BlockCheck& check, double ber);

}  // namespace fieldproof::emc
