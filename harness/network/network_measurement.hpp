#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "harness/measure/measurement.hpp"
#include "harness/network/signal_run.hpp"

// Cycle time, jitter and skew of a network: several signals, one run each on a network of its own, with the
// closed forms of the network and of a cyclic copy beside what was measured.
//
// Where a run is disturbed, cycles are compared apart for each phase, edges in the quiet one, and what can
// only be counted over all of it (losses, foreign words, torn images) is not compared. A network that stops
// for good while it is disturbed is a failure of the measurement. A row of the comparison is left out where
// the theory expects so few samples of a kind that none may come.
namespace fieldproof::network {

struct MeasurementSettings {
  std::string protocol;
  std::vector<measure::SquareWave> signals;
  kernel::Duration duration = 60 * kernel::kSecond;  // of each signal
  std::uint64_t seed = 1;
  double tolerance_percent = 2;
  // A disturbance of each signal's run, in words by `conditions`; see SignalSettings.
  std::function<void(Network&)> disturb{};
  measure::PhaseDuring phase_during{};
  measure::NextDisturbance next_disturbance{};
  std::vector<measure::Condition> conditions{};
  std::function<void(std::size_t done)> on_progress{};  // after each signal
  // A stop ends it with the signals that are through: it is not complete then.
  std::stop_token stop{};
};

using MakeNetwork = std::function<std::unique_ptr<Network>(std::uint64_t seed)>;

// `is_sampling`: inputs are sampled once in a cycle of this kind.
std::vector<measure::Comparison> compare_cycles(const CycleKind& kind, const measure::Distribution& times,
                                                bool is_sampling);
std::vector<measure::Comparison> compare_path(const SignalRecord& record, const PathRecord& path);

measure::Measurement measure_network(const MakeNetwork& make, const MeasurementSettings& settings);

}  // namespace fieldproof::network
