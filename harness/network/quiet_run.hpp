#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/network/exchange_statistics.hpp"
#include "harness/network/network.hpp"

// A network that runs undisturbed for so many cycles, all words changing: how long they take, and whether
// each word arrives.
namespace fieldproof::network {

struct QuietRun {
  bool came_up = false;
  std::vector<kernel::Duration> cycles;  // of the first kind
  ErrorStatistics counts;                // from when it had come up and each word had arrived once
};

// `network` has not been started. Ends earlier where it stops.
QuietRun run_quietly(Network& network, std::size_t cycles, std::uint64_t seed);

}  // namespace fieldproof::network
