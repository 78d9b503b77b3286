#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/measure/edge_skew.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/measure/signal_generator.hpp"
#include "harness/network/network.hpp"

// One signal on a network that runs: a function generator at every input that its controller copies, and a
// recorder there and at the output that it is copied to.
//
// The signal comes in trains of a few periods. The phases of the trains divide one cycle evenly, in random
// order, and the input rests after each train until the output shows its end; harness/measure/README.md says
// why a continuous signal would not do.
//
// Contract: everything follows from network, settings and seed. A network that copies nothing is refused with
// kernel::Error(configuration), and so is one that does not get to exchange data.
namespace fieldproof::network {

struct SignalSettings {
  measure::SquareWave wave;
  kernel::Duration duration =
      60 * kernel::kSecond;  // of trains and rests together; at least one train is run
  std::int64_t periods_per_train = 8;
  std::uint64_t seed = 1;
  // Called once when the network exchanges data: puts channels on its receivers, for instance bursts. What it
  // puts there must outlive the run. A network that stops stays stopped.
  std::function<void(Network&)> disturb{};
  // Tells quiet, burst and recovery of that disturbance apart.
  measure::PhaseDuring phase_during{};
  // Says when it is on the line.
  measure::NextDisturbance next_disturbance{};
  // Of the time courses of cycles; equally long ones.
  std::size_t most_windows = 400;
};

struct PathRecord {
  CopiedPath path;
  measure::EdgeSkew skew;
  measure::Trace trace;  // of the first train, from the start of a cycle on
};

// Times from the begin of a cycle of one kind to that of the next, or of delays, ps.
struct CycleRecord {
  CycleKind kind;
  measure::PhasedDistribution times{};
  measure::TimeCourse course{};  // since the begin of the first train
};

struct SignalRecord {
  SignalSettings settings;
  std::int64_t trains = 0;
  kernel::Duration lasted{};  // of trains and rests together
  std::vector<CycleRecord> cycles;
  std::vector<PathRecord> paths;
  std::vector<measure::Band> bands;  // of the disturbance, since the begin of the first train
  // Images of the words that are copied together from one station to one other.
  std::uint64_t images = 0;
  std::uint64_t torn_images = 0;
  std::uint64_t data_exchanges = 0;
  std::uint64_t service_exchanges = 0;
  std::uint64_t unserved_exchanges = 0;
  std::uint64_t retries = 0;
  std::vector<measure::Count> delivery_faults;
  std::vector<measure::Count> remarks;
  // A disturbance has stopped the network: it exchanges no data at the end.
  bool has_stopped = false;
  std::string complaint{};           // of its controller, then
  kernel::Duration stopped_after{};  // since the begin of the first train: its last data exchange
};

// `network` has not been started.
SignalRecord record_signal(Network& network, const SignalSettings& settings);

}  // namespace fieldproof::network
