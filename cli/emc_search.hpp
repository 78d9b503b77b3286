// What `emc` searches around its table of levels: where each criterion begins, and how far the verdict
// depends on parameters of the coupling that nobody has measured. Both are made of short tests.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/emc_case.hpp"
#include "emc/sensitivity.hpp"
#include "emc/threshold_search.hpp"

namespace fieldproof::cli {

// Runs the tests, over the threads; nothing where they were stopped.
using RunTests = std::function<std::optional<std::vector<emc::ImmunityResult>>(const emc::LineResponse&,
                                                                               std::vector<EmcCase>)>;

// Of what probes are made: a test of each repetition and polarity.
struct EmcProbing {
  std::vector<EmcCase> tests;
  kernel::Duration duration{};  // of each
  RunTests run;
  // Is told each test that showed something, and what; may be empty.
  std::function<void(const EmcCase&, const emc::ImmunityResult&)> note{};

  // A twentieth of the time of a test, 1 s at least where a test has as much.
  static kernel::Duration duration_for(kernel::Duration test);
  // The worst criterion; nothing where one was stopped, did not come up, or met no burst.
  std::optional<emc::Criterion> worst(const emc::LineResponse& response, const emc::Level& level) const;
};

struct EmcSearch {
  emc::Thresholds thresholds;
  std::optional<emc::Thresholds> references{};  // of the same network without implementations of the call
  std::size_t tests_per_probe = 0;
  kernel::Duration duration{};

  std::size_t tests() const { return thresholds.probes.size() * tests_per_probe; }
};

EmcSearch search_thresholds(const EmcProbing& probing, const emc::LineResponse& response, double top_volts);
std::string search_text(const EmcSearch& search);

struct EmcSensitivity {
  emc::Level level = emc::Level::standard(emc::PortKind::signal, 1);
  emc::Criterion criterion = emc::Criterion::a;  // with the parameters of the profile
  std::vector<emc::ParameterRange> parameters;
  bool is_complete = true;
  std::size_t tests = 0;
  kernel::Duration duration{};
};

EmcSensitivity search_sensitivity(const EmcProbing& probing, const emc::Coupling& coupling,
                                  const emc::Level& level);
std::string sensitivity_text(const EmcSensitivity& sensitivity);

}  // namespace fieldproof::cli
