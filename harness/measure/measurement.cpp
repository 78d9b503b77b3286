#include "harness/measure/measurement.hpp"

#include <algorithm>

namespace fieldproof::measure {

Agreement agreement(const Measurement& measurement) {
  const Agreement least = measurement.is_complete ? Agreement::holds : Agreement::open;
  return std::max(least, agreement(measurement, Phase::quiet).value_or(Agreement::open));
}

std::optional<Agreement> agreement(const Measurement& measurement, Phase phase) {
  std::optional<Agreement> worst;
  for (const Series& series : measurement.series) {
    // Nothing is less than any agreement.
    worst = std::max(worst, agreement(series.comparisons, measurement.tolerance_percent, phase));
  }
  return worst;
}

}  // namespace fieldproof::measure
