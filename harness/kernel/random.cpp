#include "harness/kernel/random.hpp"

#include <limits>

#include "harness/kernel/check.hpp"

namespace fieldproof::kernel {
namespace {

// FNV-1a, 64 bit.
constexpr std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  return hash;
}

// 2 * artanh(s) = ln((1 + s) / (1 - s)) for |s| <= 0.172: the first term left out is below 2^-56 of the sum.
constexpr double twice_artanh(double s) {
  const double square = s * s;
  double sum = 1.0 / 21;
  for (int odd = 19; odd >= 3; odd -= 2) sum = sum * square + 1.0 / odd;
  return 2 * s + 2 * s * (square * sum);
}

// ln 2 in two parts: the first has so few digits that its product with an exponent is exact.
constexpr double kLog2High = 0x1.62e42fefa3800p-1;
constexpr double kLog2Low = 0x1.ef35793c76730p-45;

// Reciprocals of the middles of 128 parts of [1, 2) and the logarithms of what they stand for.
constexpr unsigned kPartBits = 7;
struct LogarithmParts {
  std::array<double, 1U << kPartBits> reciprocal{};
  std::array<double, 1U << kPartBits> logarithm{};
};

constexpr LogarithmParts logarithm_parts() {
  LogarithmParts parts;
  for (std::size_t k = 0; k < parts.reciprocal.size(); ++k) {
    const double middle = 1 + (static_cast<double>(k) + 0.5) / static_cast<double>(parts.reciprocal.size());
    const double reciprocal = 1 / middle;
    // In two halves, where the series is short.
    const double half = 0.75;
    parts.reciprocal[k] = reciprocal;
    parts.logarithm[k] = -twice_artanh((half - 1) / (half + 1)) -
                         twice_artanh((reciprocal / half - 1) / (reciprocal / half + 1));
  }
  return parts;
}

constexpr LogarithmParts kParts = logarithm_parts();

// ln(n / 2^53) for 1 <= n <= 2^53, exact to 2^-52 in size: a skip needs no more, and the division and the
// long series of portable_log cost four times as much.
double log_of_fraction(std::uint64_t n) {
  const auto bits = std::bit_cast<std::uint64_t>(static_cast<double>(n));
  const auto exponent = static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023 - 53);
  const auto mantissa = std::bit_cast<double>((bits & 0x000F'FFFF'FFFF'FFFF) | 0x3FF0'0000'0000'0000);
  const std::size_t part = (bits >> (52 - kPartBits)) & (kParts.reciprocal.size() - 1);
  const double r = mantissa * kParts.reciprocal[part] - 1;  // at most 2^-8 in size
  const double square = r * r;
  const double tail =
      (r * (1.0 / 3) - 0.5) + square * ((r * (1.0 / 5) - 0.25) + square * (r * (1.0 / 7) - 1.0 / 6));
  const double sum =
      exponent * kLog2High + (exponent * kLog2Low + (kParts.logarithm[part] + (r + square * tail)));
  return sum < 0 ? sum : 0;  // next to 1 the rounding may have the last word about the sign
}

}  // namespace

Random Random::split(std::string_view label) const {
  return Random(child_seed(branch_seed(seed_, kLabelled), hash_of(label)));
}

std::uint64_t Random::geometric(double p) {
  return GeometricSkip(p)(*this);
}

double portable_log(double x) {
  constexpr std::uint64_t kMantissa = 0x000F'FFFF'FFFF'FFFF;
  constexpr std::uint64_t kExponentOfOne = 0x3FF0'0000'0000'0000;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<std::int64_t>(bits >> 52) - 1023;
  auto mantissa = std::bit_cast<double>((bits & kMantissa) | kExponentOfOne);
  // Between sqrt(1/2) and sqrt(2), where the series is short.
  if (mantissa > 1.4142135623730951) {
    mantissa *= 0.5;
    ++exponent;
  }
  const auto scale = static_cast<double>(exponent);
  return scale * kLog2High + (twice_artanh((mantissa - 1) / (mantissa + 1)) + scale * kLog2Low);
}

double portable_log_of_complement(double p) {
  return p < 0.25 ? -twice_artanh(p / (2 - p)) : portable_log(1 - p);
}

GeometricSkip::GeometricSkip(double p) {
  FIELDPROOF_CHECK(p == p, "a probability is not a number");
  if (p >= 1) {
    inverse_log_of_miss_ = 0;
  } else if (p <= 0) {
    inverse_log_of_miss_ = -std::numeric_limits<double>::infinity();
  } else {
    inverse_log_of_miss_ = 1 / portable_log_of_complement(p);
  }
}

std::uint64_t GeometricSkip::operator()(Random& random) const {
  const double log_of_uniform = log_of_fraction((random.next() >> 11) + 1);
  const double skip = log_of_uniform * inverse_log_of_miss_;
  // Written so that also "0 * infinity" (the draw was exactly 1 and no hit ever comes) gives the largest
  // number.
  return skip < 0x1p64 ? static_cast<std::uint64_t>(skip) : std::numeric_limits<std::uint64_t>::max();
}

}  // namespace fieldproof::kernel
