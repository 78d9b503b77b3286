#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/measure/edge_skew.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/measure/signal_generator.hpp"
#include "harness/segment/segment.hpp"
#include "protocols/interbus/network.hpp"
#include "protocols/interbus/ring.hpp"
#include "protocols/interbus/skew.hpp"

// One signal on a network that runs: a function generator at every input word that the master copies, and a
// recorder there and at the output word that it is copied to.
//
// The signal comes in trains of a few periods. The phases of the trains divide one cycle evenly, in random
// order, and the input rests behind each train until the output shows its end; harness/measure/README.md says
// why a continuous signal would not do.
//
// Contract: everything follows from network, settings and seed. A network without a copy task is refused with
// kernel::Error(configuration), and so is one that does not get to exchange data.
namespace fieldproof::interbus {

struct SignalSettings {
  measure::SquareWave wave;
  kernel::Duration duration =
      60 * kernel::kSecond;  // of trains and rests together; at least one train is run
  std::int64_t periods_per_train = 8;
  LatchModel latch = LatchModel::frame_edges;
  std::uint64_t seed = 1;
  // Stations instead of references with that latch model.
  Ring::MakeSlave make_slave{};
  // Called once when the ring exchanges data: puts channels on its receivers, for instance bursts. What it
  // puts there must outlive the run. A bus that stops stays stopped.
  std::function<void(Ring&, segment::Segment&)> disturb{};
  // Tells quiet, burst and recovery of that disturbance apart.
  measure::PhaseDuring phase_during{};
};

// What one rule of the copy task joins; positions count from 1 in ring order.
struct CopiedPath {
  int from = 0;
  unsigned input_word = 0;
  int to = 0;
  unsigned output_word = 0;
  std::string name;  // "di16 word 0 to do16 word 0"
};

std::vector<CopiedPath> copied_paths(const NetworkDescription& network);

struct PathRecord {
  CopiedPath path;
  measure::EdgeSkew skew;
  measure::Trace trace;  // of the first train, from the start of a cycle on
};

struct SignalRecord {
  SignalSettings settings;
  std::int64_t trains = 0;
  measure::PhasedDistribution cycle_times;  // ps from the start of a data cycle to that of the next
  std::vector<PathRecord> paths;
  // Images of the words that are copied from one station to one other.
  std::uint64_t images = 0;
  std::uint64_t torn_images = 0;
  std::uint64_t data_cycles = 0;
  std::uint64_t id_cycles = 0;
  std::uint64_t rejected_cycles = 0;
  // A disturbance has stopped the bus: it exchanges no data at the end.
  bool has_stopped = false;
};

SignalRecord record_signal(const NetworkDescription& network, const SignalSettings& settings);

}  // namespace fieldproof::interbus
