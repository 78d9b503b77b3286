#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "harness/measure/measurement.hpp"
#include "protocols/interbus/signal_run.hpp"

// Cycle time, jitter and skew of a network: several signals, one run each, with the theory of skew.hpp and
// timing.hpp beside what was measured.
//
// Where a run is disturbed, the comparisons are those of its quiet phase, and what can only be counted over
// all of it (losses, foreign words, torn images) is not compared. A row of the comparison is left out where
// the theory expects so few samples of a kind that none may come.
namespace fieldproof::interbus {

struct MeasurementSettings {
  std::vector<measure::SquareWave> signals;
  kernel::Duration duration = 60 * kernel::kSecond;  // of each signal
  LatchModel latch = LatchModel::frame_edges;
  std::uint64_t seed = 1;
  double tolerance_percent = 2;
  // A disturbance of each signal's run, told in words by `conditions`; see SignalSettings.
  std::function<void(Ring&, segment::Segment&)> disturb{};
  measure::PhaseDuring phase_during{};
  std::vector<measure::Condition> conditions{};
  std::function<void(std::size_t done)> on_progress{};  // after each signal
};

// "M2", and what it means.
std::string_view name(LatchModel model);
std::string_view describe(LatchModel model);

// The data cycle time that the structure gives, or the requested one where that is longer.
kernel::Duration cycle_time_in_force(const NetworkDescription& network);

// From the sample at the start of a frame at one station to the latch at the end of the frame at another.
kernel::Duration frame_between(const NetworkDescription& network, const CopiedPath& path);

// The delay of an edge on a path: that of the latch model, with the way from the one station to the other.
EdgeDelay path_delay(const NetworkDescription& network, const CopiedPath& path, LatchModel model);

std::vector<measure::Comparison> compare_cycles(const NetworkDescription& network,
                                                const measure::Distribution& cycle_times);
std::vector<measure::Comparison> compare_path(const NetworkDescription& network, const SignalRecord& record,
                                              const PathRecord& path);

measure::Measurement measure_network(const NetworkDescription& network, const MeasurementSettings& settings);

}  // namespace fieldproof::interbus
