#pragma once

#include <cstdint>
#include <deque>

#include "harness/kernel/time.hpp"
#include "harness/traffic/poisson_arrivals.hpp"

// Queues of one stream of packets, filled when somebody looks.
namespace fieldproof::traffic {

// Packets that are told apart.
struct TimedQueue {
  PoissonArrivals arrivals;
  std::deque<kernel::Time> waiting{};

  void fill(kernel::Time until) {
    for (; arrivals.next() <= until; arrivals.draw()) waiting.push_back(arrivals.next());
  }
};

// Packets that are only counted.
struct CountedQueue {
  PoissonArrivals arrivals;
  std::uint64_t waiting = 0;

  void fill(kernel::Time until) {
    for (; arrivals.next() <= until; arrivals.draw()) ++waiting;
  }
};

}  // namespace fieldproof::traffic
