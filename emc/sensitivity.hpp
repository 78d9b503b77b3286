// Over which range of each parameter of the coupling that nobody has measured a criterion stays what it is.
//
// One parameter at a time, the others as the profile has them: from half to twice its value in steps of the
// square root of two, of decibels from 6 dB less to 6 dB more in steps of 3 dB, within the parameter's range.
// What the standard fixes, and what is off (infinite, or 0 where a factor changes nothing), stays.
// Parameters that are wrong together can do more than each of them.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "emc/coupling.hpp"
#include "emc/immunity.hpp"

namespace fieldproof::emc {

// The values of a parameter that are tried, in order, without its own; empty where it stays.
std::vector<double> values_around(const CouplingParameter& parameter, const Coupling& coupling);

struct ParameterRange {
  std::string_view name;
  std::string_view unit;
  double value = 0;  // in the profile
  // Where the criterion is what it is in the profile, without a gap around it.
  double from = 0;
  double to = 0;
  // What it is at the next value tried below and above, and that value; nothing where none was tried.
  std::optional<std::pair<double, Criterion>> below{};
  std::optional<std::pair<double, Criterion>> above{};

  bool holds() const { return !below && !above; }
};

// The criterion with a coupling; nothing: stopped.
using TryCoupling = std::function<std::optional<Criterion>(const Coupling& coupling)>;

// The range of one parameter; nothing where it stays or was stopped.
std::optional<ParameterRange> range_of(const CouplingParameter& parameter, const Coupling& coupling,
                                       Criterion criterion, const TryCoupling& try_coupling);

}  // namespace fieldproof::emc
