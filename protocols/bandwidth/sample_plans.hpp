#pragma once

#include <cstdint>
#include <vector>

#include "protocols/bandwidth/allocation.hpp"
#include "protocols/bandwidth/window_traffic.hpp"

// Networks whose plans were worked out by another program: ten nodes, each with a non-real-time queue; sensor
// n at node 2n, controller n at node 2n + 1.
namespace fieldproof::bandwidth {

inline Demand sample_demand(const std::vector<std::int64_t>& bounds_ms) {
  Demand demand;
  for (const std::int64_t bound : bounds_ms) demand.bounds.push_back(bound * kernel::kMillisecond);
  demand.nodes = 10;
  demand.overhead = 100 * kernel::kMicrosecond;
  demand.periodic_packet = 400 * kernel::kMicrosecond;
  return demand;
}

// Six data in each slot.
inline Demand whole_density() {
  return sample_demand({60, 60, 100, 100});
}
// 3.75 data in the mean.
inline Demand fractional_density() {
  return sample_demand({60, 100, 180, 340});
}

inline WindowTraffic traffic_of(const Demand& demand, std::int64_t packet_us) {
  const Allocation allocation = allocate(demand);
  WindowTraffic traffic;
  traffic.nodes = demand.nodes;
  traffic.slot = allocation.slot;
  traffic.overhead = demand.overhead;
  traffic.periodic_packet = demand.periodic_packet;
  traffic.real_time_packet = demand.real_time_packet;
  traffic.non_real_time_packet = packet_us * kernel::kMicrosecond;
  for (std::size_t n = 0; n < allocation.loops.size(); ++n) {
    const LoopShare& loop = allocation.loops[n];
    traffic.loops.push_back({.sensor = static_cast<std::uint8_t>(2 * n),
                             .controller = static_cast<std::uint8_t>(2 * n + 1),
                             .every = loop.every,
                             .sensor_offset = loop.sensor_offset,
                             .controller_offset = loop.controller_offset});
  }
  for (unsigned node = 0; node < demand.nodes; ++node) {
    traffic.non_real_time.push_back({.node = static_cast<std::uint8_t>(node)});
    if (node < demand.real_time_queues)
      traffic.real_time.push_back({.node = static_cast<std::uint8_t>(node)});
  }
  return traffic;
}

}  // namespace fieldproof::bandwidth
