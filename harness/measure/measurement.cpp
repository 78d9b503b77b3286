#include "harness/measure/measurement.hpp"

#include <algorithm>

namespace fieldproof::measure {

Agreement agreement(const Measurement& measurement) {
  Agreement worst = Agreement::holds;
  for (const Series& series : measurement.series) {
    worst = std::max(worst, agreement(series.comparisons, measurement.tolerance_percent));
  }
  return worst;
}

}  // namespace fieldproof::measure
