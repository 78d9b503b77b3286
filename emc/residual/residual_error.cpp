#include "emc/residual/residual_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>

#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

namespace mp = boost::multiprecision;

template <unsigned kDigits>
using Binary = mp::number<mp::cpp_bin_float<kDigits, mp::digit_base_2>, mp::et_off>;

constexpr unsigned kShort = 320;
constexpr unsigned kLong = 3400;  // 1e-15 to the 33rd power, and 1000 digits more
constexpr unsigned kGoodDigits = 60;
constexpr unsigned kLooks = 256;
constexpr unsigned kNarrowings = 60;
constexpr double kFlat = 1e-12;  // near 1/2 the curve may be flat to the last digits of a double

void check_rate(double ber) {
  const bool is_possible = ber == 0 || (ber >= kLeastBer && ber <= kGreatestBer);
  if (!is_possible) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("a bit-error rate of {} is neither 0 nor from {} to {}", ber, kLeastBer, kGreatestBer));
  }
}

// The probability that the check finds nothing, corrupted or not, by Horner's rule from the largest weight.
// The word of weight 0 is always there.
template <typename Real>
Real acceptance(const DualWeights& dual, double ber) {
  const Real step = 1 - 2 * Real(ber);
  Real sum = 0;
  int steps = 0;  // that the sum lags behind
  for (std::size_t j = dual.count.size(); j-- > 0; ++steps) {
    if (dual.count[j] == 0) continue;
    sum = sum * (steps == 1 ? step : Real(mp::pow(step, steps))) + dual.count[j];
    steps = 0;
  }
  return mp::ldexp(sum, -static_cast<int>(dual.width));
}

template <typename Real>
struct Difference {
  Real value;
  bool is_good;  // with kGoodDigits binary digits to spare
};

template <typename Real>
Difference<Real> undetected(const DualWeights& dual, double ber) {
  const Real untouched = mp::pow(1 - Real(ber), static_cast<int>(dual.bits));
  const Real value = acceptance<Real>(dual, ber) - untouched;
  // Each step of Horner's rule rounds twice, the powers less often; everything is at most 1.
  const Real error = std::numeric_limits<Real>::epsilon() * (4 * (Real(dual.bits) + 100));
  return {value, value > mp::ldexp(error, static_cast<int>(kGoodDigits))};
}

double corrupted_probability(unsigned bits, double ber) {
  return -std::expm1(static_cast<double>(bits) * std::log1p(-ber));
}

// The rate between the neighbours of the largest look where P_ue is largest, by the golden section.
WorstError narrowed(const DualWeights& dual, double low, double high, WorstError worst) {
  constexpr double kGolden = 0.6180339887498949;
  for (unsigned i = 0; i < kNarrowings && high - low > 1e-12 * high; ++i) {
    const double left = high - kGolden * (high - low);
    const double right = low + kGolden * (high - low);
    const double at_left = undetected_error_probability(dual, left);
    const double at_right = undetected_error_probability(dual, right);
    if (at_left > worst.probability) worst = {left, at_left, worst.rises_throughout};
    if (at_right > worst.probability) worst = {right, at_right, worst.rises_throughout};
    (at_left < at_right ? low : high) = at_left < at_right ? left : right;
  }
  return worst;
}

}  // namespace

double undetected_error_probability(const DualWeights& dual, double ber) {
  check_rate(ber);
  if (ber == 0 || dual.bits <= dual.width) return 0;
  const auto first = undetected<Binary<kShort>>(dual, ber);
  if (first.is_good) return static_cast<double>(first.value);
  const auto second = undetected<Binary<kLong>>(dual, ber);
  FIELDPROOF_CHECK(second.is_good, "an undetected-error probability has no digits left");
  return static_cast<double>(second.value);
}

double undetected_share_of_corrupted(const DualWeights& dual, double ber) {
  const double undetected = undetected_error_probability(dual, ber);
  return undetected == 0 ? 0 : undetected / corrupted_probability(dual.bits, ber);
}

WorstError worst_undetected_error(const DualWeights& dual, double up_to) {
  check_rate(up_to);
  WorstError worst{up_to, undetected_error_probability(dual, up_to), true};
  const double from = std::min(up_to, 1.0 / dual.bits);
  if (worst.probability == 0 || from == up_to) return worst;
  const double ratio = std::pow(up_to / from, 1.0 / kLooks);
  const auto rate = [&](unsigned look) { return look >= kLooks ? up_to : from * std::pow(ratio, look); };
  double before = 0;
  unsigned largest = kLooks;
  for (unsigned look = 0; look <= kLooks; ++look) {
    const double here = undetected_error_probability(dual, rate(look));
    if (here < before * (1 - kFlat)) worst.rises_throughout = false;
    before = here;
    if (here <= worst.probability * (1 + kFlat)) continue;
    largest = look;
    worst = {rate(look), here, worst.rises_throughout};
  }
  if (largest == kLooks) return worst;
  return narrowed(dual, rate(largest == 0 ? 0 : largest - 1), rate(largest + 1), worst);
}

double proper_polynomial_bound(unsigned width, unsigned bits, unsigned hamming_distance, double ber) {
  check_rate(ber);
  FIELDPROOF_CHECK(hamming_distance >= 1 && hamming_distance <= bits,
                   "a Hamming distance is larger than the code word");
  const boost::math::binomial flips(bits, ber);
  return std::ldexp(boost::math::cdf(complement(flips, hamming_distance - 1)), -static_cast<int>(width));
}

double upper_bound_of_share(std::uint64_t wrong, std::uint64_t total, double confidence) {
  FIELDPROOF_CHECK(wrong <= total && confidence > 0 && confidence < 1,
                   "a bound is asked for of more errors than there were chances");
  if (wrong == total) return 1;
  return boost::math::binomial::find_upper_bound_on_p(static_cast<double>(total), static_cast<double>(wrong),
                                                      1 - confidence);
}

}  // namespace fieldproof::emc
