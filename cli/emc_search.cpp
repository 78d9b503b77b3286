#include "cli/emc_search.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::cli {
namespace {

constexpr int kProbesPerTest = 20;

// "200 pF".
std::string with_unit(double value, std::string_view unit) {
  return fmt::format("{:.3g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string changes_text(const emc::ParameterRange& range) {
  std::string text(range.name);
  text += fmt::format(" {} to {}", with_unit(range.from, {}), with_unit(range.to, range.unit));
  for (const auto& other : {range.below, range.above}) {
    if (other) text += fmt::format(" ({} at {})", emc::name(other->second), with_unit(other->first, {}));
  }
  return text;
}

}  // namespace

kernel::Duration EmcProbing::duration_for(kernel::Duration test) {
  return std::min(test, std::max(test / kProbesPerTest, kernel::Duration{kernel::kSecond}));
}

std::optional<emc::Criterion> EmcProbing::worst(const emc::LineResponse& response,
                                                const emc::Level& level) const {
  std::vector<EmcCase> made = tests;
  for (std::size_t n = 0; n < made.size(); ++n) {
    made[n].bursts.settings.level = level;
    made[n].duration = duration;
    made[n].seed = seed_of(made[n], kernel::Random(made[n].seed).split("probe").seed());
  }
  const auto results = run(response, made);
  if (!results) return std::nullopt;
  emc::Criterion worst = emc::Criterion::a;
  for (std::size_t n = 0; n < results->size(); ++n) {
    const emc::ImmunityResult& result = (*results)[n];
    if (!result.came_up || (result.complaint.empty() && !result.was_disturbed())) return std::nullopt;
    if (note) note(made[n], result);
    worst = std::max(worst, result.criterion);
  }
  return worst;
}

EmcSearch search_thresholds(const EmcProbing& probing, const emc::LineResponse& response, double top_volts) {
  EmcSearch search;
  search.tests_per_probe = probing.tests.size();
  search.duration = probing.duration;
  search.thresholds = emc::find_thresholds(response.threshold_volts(), top_volts, [&](double volts) {
    return probing.worst(response, emc::Level::free(volts));
  });
  return search;
}

std::string search_text(const EmcSearch& search) {
  std::string text =
      fmt::format("threshold search: {} ({} tests of {}; what a probe does not show may still come)\n",
                  emc::text_of(search.thresholds), search.tests(), kernel::describe(search.duration));
  if (search.references) text += fmt::format("references alone: {}\n", emc::text_of(*search.references));
  return text;
}

EmcSensitivity search_sensitivity(const EmcProbing& probing, const emc::Coupling& coupling,
                                  const emc::Level& level) {
  EmcSensitivity found;
  found.level = level;
  found.duration = probing.duration;
  const auto try_coupling = [&](const emc::Coupling& tried) {
    found.tests += probing.tests.size();
    return probing.worst(emc::LineResponse(tried), level);
  };
  const auto criterion = try_coupling(coupling);
  found.is_complete = criterion.has_value();
  if (!criterion) return found;
  found.criterion = *criterion;
  for (const emc::CouplingParameter& parameter : emc::coupling_parameters()) {
    if (emc::values_around(parameter, coupling).empty()) continue;
    const auto range = emc::range_of(parameter, coupling, found.criterion, try_coupling);
    found.is_complete = range.has_value();
    if (!range) break;
    found.parameters.push_back(*range);
  }
  return found;
}

std::string sensitivity_text(const EmcSensitivity& found) {
  std::string text = fmt::format("sensitivity at {}: ", found.level.text());
  if (!found.is_complete) return text + "the search did not end\n";
  std::string holds;
  std::string changes;
  for (const emc::ParameterRange& range : found.parameters) {
    if (range.holds()) {
      holds += fmt::format("{}{}", holds.empty() ? "" : ", ", range.name);
    } else {
      changes += fmt::format("{}{}", changes.empty() ? "" : ", ", changes_text(range));
    }
  }
  text += fmt::format("{} ", emc::name(found.criterion));
  if (!changes.empty()) text += fmt::format("holds for {}; ", changes);
  text += fmt::format(
      "unchanged from half to twice, or by 6 dB, of {} ({} tests of {}, one parameter at a time)\n",
      holds.empty() ? "none" : holds, found.tests, kernel::describe(found.duration));
  return text;
}

}  // namespace fieldproof::cli
