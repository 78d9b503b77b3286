#include "harness/measure/phase.hpp"

namespace fieldproof::measure {

std::string_view name(Phase phase) {
  constexpr std::array<std::string_view, kPhases.size()> kNames = {"quiet", "burst", "recovery"};
  return kNames.at(static_cast<std::size_t>(phase));
}

Phase phase_during(const PhaseDuring& phase_during, kernel::Time from, kernel::Time to) {
  return phase_during ? phase_during(from, to) : Phase::quiet;
}

void PhasedDistribution::add(const PhasedDistribution& other) {
  for (std::size_t n = 0; n < parts_.size(); ++n) parts_.at(n).add(other.parts_.at(n));
}

Distribution PhasedDistribution::total() const {
  Distribution all;
  for (const Distribution& part : parts_) all.add(part);
  return all;
}

}  // namespace fieldproof::measure
