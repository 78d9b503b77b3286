#include "conformance/token_bus/judgeable_rules.hpp"

#include <fmt/format.h>

#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {

void expect_whole_half_bits(const token_bus::Rules& rules) {
  if (kernel::kSecond.count() % (2 * rules.phy_bit_rate) == 0) return;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format(
          "at a \"phy_bit_rate\" of {} bit/s a half bit is no whole number of picoseconds; declare one "
          "that divides 500 GHz, as 10000000 does",
          rules.phy_bit_rate));
}

void expect_possible(const token_bus::Rules& rules) {
  expect_whole_half_bits(rules);
  if (const auto why = token_bus::impossible(rules))
    throw kernel::Error(kernel::ErrorKind::configuration, *why);
}

}  // namespace fieldproof::conformance
