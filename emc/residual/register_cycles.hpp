// The cycles of a linear feedback register: every sequence that a polynomial generates, once.
//
// A sequence s with the characteristic polynomial p = sum p_k x^k of degree r satisfies sum p_k s(i + k) = 0
// and is given by its first r bits; there are 2^r of them. Shifting permutes them, because p has a constant
// term, so they fall into cycles. The cycles are not searched for: p is factored, the cycles of each prime
// power are written down (the sequences of an irreducible polynomial of degree d are the elements of the
// field with 2^d elements, shifting is multiplication by x), and sums of their sequences are the sequences of
// the product.
//
// Limits: degrees 1 to 32, constant term 1. The cycles of a repeated factor are found by walking its own
// sequences, 2^(degree of the power) of them: nothing for (x + 1)^2, the only one in the catalogue of frame
// checks, but half a GB of marks for a 32nd degree.
#pragma once

#include <cstdint>
#include <vector>

namespace fieldproof::emc {

// Over GF(2); bit k is the coefficient of x^k.
using Polynomial = std::uint64_t;

constexpr unsigned kLargestRegister = 32;

struct PrimePower {
  Polynomial prime;
  unsigned exponent;
  friend bool operator==(const PrimePower&, const PrimePower&) = default;
};

// Ascending by the prime.
std::vector<PrimePower> factors_of(Polynomial polynomial);

struct RegisterCycle {
  std::uint64_t length;
  std::uint32_t start;  // the first bits of one of its sequences, first bit lowest
};

// The bits of the sequence from the second on.
std::uint64_t shifted(std::uint64_t bits, Polynomial polynomial);

// Every cycle once, that of the zero sequence first.
std::vector<RegisterCycle> register_cycles(Polynomial polynomial);

}  // namespace fieldproof::emc
