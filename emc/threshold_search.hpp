// From which open-circuit voltage on a network shows which performance criterion.
//
// The lowest voltage at which an output can be wrong is known from the coupling: below it there is nothing to
// find. From there up to the top rungs are probed, each at twice the voltage of the one before; between the
// first rung that shows a criterion, or a worse one, and the rung before it the place is narrowed down by
// bisection of the ratio. A probe is a short test, so what it does not show may still come: B "from" and C
// "seen from" are where it was seen first, not where it begins.
//
// Contract: probes depend on voltages alone, each is made once, their number is bounded (kMostProbes).
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "emc/immunity.hpp"

namespace fieldproof::emc {

struct Thresholds {
  bool is_complete = true;
  double top_volts = 0;
  double certain_volts = 0;  // up to which no output can be wrong
  double a_up_to_volts = 0;  // the highest voltage that was found A below everything else
  // By criterion: the lowest voltage at which it, or a worse one, was seen.
  std::array<std::optional<double>, 4> seen_from{};
  std::map<double, Criterion> probes;  // the worst of each voltage
};

inline constexpr std::size_t kMostProbes = 40;

// The worst criterion at a voltage; nothing: it was stopped, or says nothing.
using Probe = std::function<std::optional<Criterion>(double volts)>;

// `from` is where an output can be wrong first. Voltages are whole volts.
Thresholds find_thresholds(double from, double top, const Probe& probe);

// What longer tests have shown counts, too: a voltage, and the worst criterion there.
void take(Thresholds& found, double volts, Criterion worst);

// "A up to 47 V, B from 52 V, C seen from 1504 V, D not seen up to 4000 V"
std::string text_of(const Thresholds& thresholds);

}  // namespace fieldproof::emc
