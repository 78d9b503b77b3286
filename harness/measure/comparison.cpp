#include "harness/measure/comparison.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {

std::string_view name(Agreement agreement) {
  constexpr std::array<std::string_view, 3> kNames = {"holds", "open", "differs"};
  return kNames.at(static_cast<std::size_t>(agreement));
}

Agreement agreement(const Comparison& comparison, double tolerance_percent) {
  FIELDPROOF_CHECK(comparison.whole > 0, "a deviation is given in parts of something");
  const double deviation = comparison.deviation_percent();
  const double beyond = (comparison.is_bound ? deviation : std::abs(deviation)) - tolerance_percent;
  if (beyond <= 0) return Agreement::holds;
  return beyond <= 300 * comparison.standard_error / comparison.whole ? Agreement::open : Agreement::differs;
}

std::optional<Agreement> agreement(std::span<const Comparison> comparisons, double tolerance_percent,
                                   Phase phase) {
  std::optional<Agreement> worst;
  for (const Comparison& one : comparisons) {
    if (one.phase == phase)
      worst = std::max(worst.value_or(Agreement::holds), agreement(one, tolerance_percent));
  }
  return worst;
}

}  // namespace fieldproof::measure
