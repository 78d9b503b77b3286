#pragma once

#include <array>
#include <functional>
#include <string_view>

#include "harness/kernel/time.hpp"
#include "harness/measure/distribution.hpp"

// A disturbed run has phases, and a quantity is told for each by itself: before and between disturbances,
// while one lasts, and while the bus recovers from one.
namespace fieldproof::measure {

enum class Phase { quiet, burst, recovery };

inline constexpr std::array kPhases = {Phase::quiet, Phase::burst, Phase::recovery};

std::string_view name(Phase phase);

// The phase of something that lasted from one instant to another: burst when any of it lay in a burst, else
// recovery when any of it lay in a recovery. Whoever disturbs knows.
using PhaseDuring = std::function<Phase(kernel::Time from, kernel::Time to)>;

// No function: all is quiet.
Phase phase_during(const PhaseDuring& phase_during, kernel::Time from, kernel::Time to);

class PhasedDistribution {
 public:
  template <typename Value>
  void add(Phase phase, Value value) {
    parts_.at(static_cast<std::size_t>(phase)).add(value);
  }
  void add(const PhasedDistribution& other);
  const Distribution& in(Phase phase) const { return parts_.at(static_cast<std::size_t>(phase)); }
  Distribution total() const;

 private:
  std::array<Distribution, kPhases.size()> parts_;
};

}  // namespace fieldproof::measure
