// The residual error of a frame check: the probability that a corrupted telegram is taken for a good one.
//
// On a binary symmetric channel with bit-error rate p a pattern goes undetected with the probability
//   P_ue(p) = 2^-r sum_j B_j (1 - 2 p)^j - (1 - p)^n
// (B_j the weights of the dual code, n the bits of message and check, r those of the check). The two sides
// are almost equal where p is small, so the difference is taken with 320 binary digits, and with 3400 where
// those do not leave 60 good ones: what is returned is exact to the digits of a double. It is 0 below 1e-307.
//
// The channel is the theory, not the line: a burst flips neighbouring bits, a polarity flips one way, and bit
// stuffing or a violated code are outside of it.
#pragma once

#include <cstdint>
#include <optional>

#include "emc/residual/dual_weights.hpp"

namespace fieldproof::emc {

// The least bit-error rate above zero, and the greatest.
constexpr double kLeastBer = 1e-15;
constexpr double kGreatestBer = 0.5;

// P_ue(p). A rate that is neither 0 nor kLeastBer to kGreatestBer is a kernel::Error (usage).
double undetected_error_probability(const DualWeights& dual, double ber);

// P_ue(p) over the probability that a telegram is corrupted at all; 0 at p = 0.
double undetected_share_of_corrupted(const DualWeights& dual, double ber);

struct WorstError {
  double ber = 0;
  double probability = 0;
  bool rises_throughout =
      false;  // P_ue never falls: the polynomial is proper at this length, as far as looked
};

// The largest P_ue at any bit-error rate up to `up_to`. Below 1/n it rises for certain; from there to `up_to`
// it is looked at 256 rates in equal ratios, and around the largest of them the maximum is narrowed down.
WorstError worst_undetected_error(const DualWeights& dual, double up_to = kGreatestBer);

// 2^-r times the probability of at least d flips: what IEC 61784-3 lets be used for a proper polynomial
// instead of the weights [from memory, unverified]. The exact weights show that it is not quite a bound even
// then: CRC-16/PROFIBUS exceeds it by 1e-4 at 64 bits, and a polynomial with the factor x + 1 twice, because
// it hides even weights only and twice as many of each.
double proper_polynomial_bound(unsigned width, unsigned bits, unsigned hamming_distance, double ber);

// Residual error rate per hour, Lambda = R(p) v m with v safety messages per hour and m receivers of each
// [from memory: IEC 61784-3, unverified].
constexpr double residual_error_rate_per_hour(double probability, double messages_per_hour,
                                              std::uint64_t receivers) {
  return probability * messages_per_hour * static_cast<double>(receivers);
}

// The least share that `wrong` of `total` would refute at this confidence (Clopper and Pearson, one side):
// true shares above it give so few only in 5 % of all campaigns. 1 when there was nothing to see.
double upper_bound_of_share(std::uint64_t wrong, std::uint64_t total, double confidence = 0.95);

}  // namespace fieldproof::emc
