#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocols/bandwidth/window_traffic.hpp"

// Do the data of each slot go within it, whatever the other queues do? Found by simulation against those who
// work against it, in the network's own order of nodes and in the worst one.
namespace fieldproof::bandwidth {

struct ProofRun {
  std::string name;
  bool is_own_order = true;
  WindowTraffic traffic;
  WindowRun run;  // the first of it, where it is many
  WindowFigures figures;

  bool holds() const { return figures.over_slot() + figures.lost() + figures.vacant() == 0; }
};

struct Proof {
  std::vector<ProofRun> runs;
  // The longest delay of a datum on the common grid in closed form: in this order of nodes, in the worst one.
  kernel::Duration slowest_own{};
  kernel::Duration slowest_of_all{};
  std::vector<kernel::Duration> longest_loop_delays;  // by loop, in the network's own order
  bool has_growing_queues = false;                    // where their packets arrive, more come than go

  std::uint64_t slots() const;
  bool holds() const;  // each run in the network's own order
  bool holds_in_any_order() const;
  kernel::Duration longest() const;
  // In the slots of the start, which are outside of the proof: controllers still wait for their first datum.
  kernel::Duration longest_of_start() const;
};

inline constexpr std::uint64_t kSlotsOfProof = 1'000'000;

// The same network with a non-real-time queue at each node and its data where their last one waits longest.
WindowTraffic worst_order(const WindowTraffic& traffic);

// `slots` are those of all runs together; less where a slot has very many visits or is very long. Throws
// kernel::Error(configuration) where even the fewest slots have too many visits to be simulated.
Proof prove(const WindowTraffic& traffic, std::uint64_t seed, std::uint64_t slots = kSlotsOfProof);

// Why the first late datum of a run is late, in words: what the line carried before it.
std::string story_of_late(const ProofRun& run);

}  // namespace fieldproof::bandwidth
