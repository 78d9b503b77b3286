#include "emc/sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fieldproof::emc {

std::vector<double> values_around(const CouplingParameter& parameter, const Coupling& coupling) {
  constexpr std::array kSensitivitySteps{-2, -1, 1, 2};
  constexpr double kStepDb = 3;
  const double value = coupling.*parameter.member;
  std::vector<double> values;
  if (parameter.standing == Standing::standard || !std::isfinite(value)) return values;
  for (const int step : kSensitivitySteps) {
    const double tried = parameter.unit == "dB" ? value + step * kStepDb : value * std::exp2(step / 2.0);
    const double within = std::clamp(tried, parameter.smallest, parameter.largest);
    if (within != value && std::ranges::find(values, within) == values.end()) values.push_back(within);
  }
  return values;
}

std::optional<ParameterRange> range_of(const CouplingParameter& parameter, const Coupling& coupling,
                                       Criterion criterion, const TryCoupling& try_coupling) {
  const double value = coupling.*parameter.member;
  ParameterRange range{parameter.name, parameter.unit, value, value, value};
  const std::vector<double> values = values_around(parameter, coupling);
  if (values.empty()) return std::nullopt;
  // Outwards from the value of the profile, until the criterion is another one.
  const auto walk = [&](auto first, auto last, double& reached, auto& other) {
    for (; first != last; ++first) {
      Coupling tried = coupling;
      tried.*parameter.member = *first;
      const auto found = try_coupling(tried);
      if (!found) return false;
      if (*found != criterion) {
        other = std::pair(*first, *found);
        return true;
      }
      reached = *first;
    }
    return true;
  };
  const auto above = std::ranges::upper_bound(values, value);
  const bool is_done = walk(above, values.end(), range.to, range.above) &&
                       walk(std::make_reverse_iterator(above), values.rend(), range.from, range.below);
  return is_done ? std::optional(range) : std::nullopt;
}

}  // namespace fieldproof::emc
