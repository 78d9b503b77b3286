#include "conformance/interbus/moved_edges.hpp"

#include <algorithm>
#include <cmath>

namespace fieldproof::conformance {

double worst_edge(SlaveBench& bench) {
  const auto telegrams = bench.out().telegrams();
  const auto bit = static_cast<double>(bench.bits(1).count());
  double worst = 0;
  std::size_t next = 0;
  for (const line::Waveform& wave : bench.out().waves()) {
    bool level = true;
    for (std::size_t n = 0; n <= wave.levels.size(); ++n) {
      if (wave.levels[n] == level) continue;
      level = !level;
      const kernel::Time edge = wave.time_of(n);
      while (next + 1 < telegrams.size() && bench.out().start_of(telegrams[next + 1]) <= edge) ++next;
      if (next >= telegrams.size()) return worst;
      const double at = static_cast<double>((edge - bench.out().start_of(telegrams[next])).count()) / bit;
      worst = std::max(worst, std::abs(at - std::round(at)));
    }
  }
  return worst;
}

}  // namespace fieldproof::conformance
