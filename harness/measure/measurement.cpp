#include "harness/measure/measurement.hpp"

#include <algorithm>

namespace fieldproof::measure {

Agreement agreement(const Measurement& measurement) {
  Agreement worst = measurement.is_complete ? Agreement::holds : Agreement::open;
  for (const Series& series : measurement.series) {
    worst = std::max(worst, agreement(series.comparisons, measurement.tolerance_percent));
  }
  return worst;
}

}  // namespace fieldproof::measure
