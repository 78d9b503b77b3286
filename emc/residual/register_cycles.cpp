#include "emc/residual/register_cycles.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "harness/kernel/check.hpp"

namespace fieldproof::emc {
namespace {

constexpr Polynomial kX = 2;

unsigned degree_of(Polynomial p) {
  return static_cast<unsigned>(std::bit_width(p)) - 1;
}

struct Division {
  Polynomial quotient;
  Polynomial remainder;
};

Division divide(Polynomial dividend, Polynomial divisor) {
  Division result{0, dividend};
  while (result.remainder != 0 && degree_of(result.remainder) >= degree_of(divisor)) {
    const unsigned shift = degree_of(result.remainder) - degree_of(divisor);
    result.quotient |= Polynomial{1} << shift;
    result.remainder ^= divisor << shift;
  }
  return result;
}

Polynomial multiply(Polynomial a, Polynomial b) {
  Polynomial product = 0;
  for (; b != 0; b >>= 1, a <<= 1) product ^= (b & 1) != 0 ? a : 0;
  return product;
}

Polynomial power(Polynomial a, std::uint64_t exponent, Polynomial modulus) {
  Polynomial result = 1;
  for (; exponent > 0; exponent >>= 1) {
    if ((exponent & 1) != 0) result = divide(multiply(result, a), modulus).remainder;
    a = divide(multiply(a, a), modulus).remainder;
  }
  return result;
}

std::vector<std::uint64_t> primes_of(std::uint64_t number) {
  std::vector<std::uint64_t> primes;
  for (std::uint64_t prime = 2; number > 1; ++prime) {
    if (prime * prime > number) prime = number;
    if (number % prime != 0) continue;
    primes.push_back(prime);
    while (number % prime == 0) number /= prime;
  }
  return primes;
}

std::uint64_t units_of_field(Polynomial prime) {
  return (std::uint64_t{1} << degree_of(prime)) - 1;
}

std::uint64_t order_in_field(Polynomial element, Polynomial prime) {
  std::uint64_t order = units_of_field(prime);
  for (const std::uint64_t q : primes_of(order)) {
    while (order % q == 0 && power(element, order / q, prime) == 1) order /= q;
  }
  return order;
}

// An element whose powers are all elements but zero.
Polynomial generator_of_field(Polynomial prime) {
  Polynomial element = 1;
  while (order_in_field(element, prime) != units_of_field(prime)) ++element;
  return element;
}

// The sequence of a field element u: the highest coefficients of u, u x, u x^2, ...
std::uint32_t sequence_of(Polynomial element, Polynomial prime) {
  std::uint32_t bits = 0;
  for (unsigned i = 0; i < degree_of(prime); ++i) {
    bits |= static_cast<std::uint32_t>((element >> (degree_of(prime) - 1)) & 1) << i;
    element = divide(element << 1, prime).remainder;
  }
  return bits;
}

// Multiplying by x walks along a cycle, so the cycles are the cosets of the powers of x.
std::vector<RegisterCycle> cycles_of_prime(Polynomial prime) {
  const std::uint64_t length = order_in_field(divide(kX, prime).remainder, prime);
  const Polynomial generator = generator_of_field(prime);
  std::vector<RegisterCycle> cycles{{1, 0}};
  Polynomial element = 1;
  for (std::uint64_t coset = 0; coset < units_of_field(prime) / length; ++coset) {
    cycles.push_back({length, sequence_of(element, prime)});
    element = divide(multiply(element, generator), prime).remainder;
  }
  return cycles;
}

std::vector<RegisterCycle> cycles_by_walking(Polynomial polynomial) {
  const std::uint64_t count = std::uint64_t{1} << degree_of(polynomial);
  std::vector<bool> is_seen(count);
  std::vector<RegisterCycle> cycles;
  for (std::uint64_t start = 0; start < count; ++start) {
    if (is_seen[start]) continue;
    RegisterCycle cycle{0, static_cast<std::uint32_t>(start)};
    for (std::uint64_t at = start; !is_seen[at]; at = shifted(at, polynomial), ++cycle.length) {
      is_seen[at] = true;
    }
    cycles.push_back(cycle);
  }
  return cycles;
}

Polynomial expanded(const PrimePower& factor) {
  Polynomial product = 1;
  for (unsigned k = 0; k < factor.exponent; ++k) product = multiply(product, factor.prime);
  return product;
}

// The first `count` bits of the sequence whose first bits are given.
std::uint32_t continued(std::uint32_t start, Polynomial polynomial, unsigned count) {
  std::uint64_t at = start;
  std::uint32_t bits = 0;
  for (unsigned i = 0; i < count; ++i, at = shifted(at, polynomial)) {
    bits |= static_cast<std::uint32_t>(at & 1) << i;
  }
  return bits;
}

// Cycles of the factor, with as many first bits as sequences of the whole polynomial have.
std::vector<RegisterCycle> cycles_within(const PrimePower& factor, Polynomial whole) {
  const Polynomial part = expanded(factor);
  std::vector<RegisterCycle> cycles = factor.exponent == 1 ? cycles_of_prime(part) : cycles_by_walking(part);
  for (RegisterCycle& cycle : cycles) cycle.start = continued(cycle.start, part, degree_of(whole));
  return cycles;
}

// Sums of a sequence of one cycle and one of another: shifting both keeps their distance, which counts only
// modulo the common divisor of the lengths.
void append_sums(const RegisterCycle& a, const RegisterCycle& b, Polynomial whole,
                 std::vector<RegisterCycle>& sums) {
  const std::uint64_t distances = std::gcd(a.length, b.length);
  std::uint64_t other = b.start;
  for (std::uint64_t distance = 0; distance < distances; ++distance) {
    sums.push_back({a.length / distances * b.length, a.start ^ static_cast<std::uint32_t>(other)});
    other = shifted(other, whole);
  }
}

}  // namespace

std::uint64_t shifted(std::uint64_t bits, Polynomial polynomial) {
  const unsigned degree = degree_of(polynomial);
  const Polynomial taps = polynomial ^ (Polynomial{1} << degree);
  const auto next = static_cast<std::uint64_t>(std::popcount(bits & taps) & 1);
  return (bits >> 1) | (next << (degree - 1));
}

std::vector<PrimePower> factors_of(Polynomial polynomial) {
  std::vector<PrimePower> factors;
  // Odd divisors in ascending order: the first that divides is prime.
  for (Polynomial divisor = 3; polynomial > 1; divisor += 2) {
    if (2 * degree_of(divisor) > degree_of(polynomial)) divisor = polynomial;
    unsigned exponent = 0;
    while (polynomial > 1) {
      const Division division = divide(polynomial, divisor);
      if (division.remainder != 0) break;
      polynomial = division.quotient;
      ++exponent;
    }
    if (exponent > 0) factors.push_back({divisor, exponent});
  }
  return factors;
}

std::vector<RegisterCycle> register_cycles(Polynomial polynomial) {
  FIELDPROOF_CHECK(
      (polynomial & 1) == 1 && polynomial > 1 && degree_of(polynomial) <= kLargestRegister,
      "the cycles of a register are asked for a polynomial without constant term, or beyond degree 32");
  std::vector<RegisterCycle> cycles{{1, 0}};
  for (const PrimePower& factor : factors_of(polynomial)) {
    std::vector<RegisterCycle> sums;
    const std::vector<RegisterCycle> others = cycles_within(factor, polynomial);
    for (const RegisterCycle& a : cycles) {
      for (const RegisterCycle& b : others) append_sums(a, b, polynomial, sums);
    }
    cycles = std::move(sums);
  }
  std::uint64_t sequences = 0;
  for (const RegisterCycle& cycle : cycles) sequences += cycle.length;
  FIELDPROOF_CHECK(sequences == std::uint64_t{1} << degree_of(polynomial),
                   "the cycles of a register do not hold each of its sequences once");
  return cycles;
}

}  // namespace fieldproof::emc
