#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "protocols/bandwidth/network.hpp"
#include "protocols/bandwidth/proof.hpp"
#include "protocols/bandwidth/stability.hpp"

// The bandwidth of a network file, allocated and proven.
namespace fieldproof::bandwidth {

struct Plan {
  Network network;
  std::uint64_t seed = 1;
  Demand demand{};
  Allocation allocation{};
  WindowTraffic traffic{};
  Stability stability{};
  std::optional<Remedy> remedy{};  // where it is not feasible
  std::optional<Proof> proof{};    // where it is

  // Non-real-time queues need a packet, and there is room for none.
  bool lacks_room() const;
  bool keeps_bounds() const;  // of loop delays, in the proof
  // The closed form of the longest delay on the common grid, which no simulation has to meet.
  bool keeps_slot() const;
  bool is_stable() const;  // in the mean, and no queue grew where packets arrive
  bool is_proven() const;
};

Plan plan_bandwidth(const Network& network, std::uint64_t seed);

std::string plan_text(const Plan& plan);
// Valid against bandwidth_plan.schema.json, "schema" is "fieldproof/bandwidth_plan/1".
std::string plan_json(const Plan& plan);

}  // namespace fieldproof::bandwidth
