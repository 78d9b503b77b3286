#include "emc/exponential.hpp"

#include <bit>
#include <cstdint>

#include "harness/kernel/check.hpp"
#include "harness/kernel/random.hpp"

namespace fieldproof::emc {
namespace {

constexpr double kLog2 = 0x1.62e42fefa39efp-1;
// ln 2 in two parts: the first has so few digits that its product with an exponent is exact.
constexpr double kLog2High = 0x1.62e42fefa3800p-1;
constexpr double kLog2Low = 0x1.ef35793c76730p-45;
constexpr double kLog10 = 0x1.26bb1bbb55516p+1;

}  // namespace

double portable_exp(double x) {
  FIELDPROOF_CHECK(x <= 700, "an exponential stays within the range of its type");
  if (x < -700) return 0;
  const double scaled = x / kLog2;
  const auto exponent = static_cast<std::int64_t>(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
  const auto whole = static_cast<double>(exponent);
  const double rest = (x - whole * kLog2High) - whole * kLog2Low;
  // |rest| <= 0.347: the first term left out is below 2^-58.
  double sum = 1;
  for (int n = 14; n >= 1; --n) sum = 1 + sum * rest / n;
  return sum * std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

double portable_power(double x, double y) {
  return portable_exp(y * kernel::portable_log(x));
}

double voltage_factor(double attenuation_db) {
  return portable_exp(-attenuation_db * kLog10 / 20);
}

}  // namespace fieldproof::emc
