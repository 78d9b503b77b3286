#include "protocols/bandwidth/plan.hpp"

namespace fieldproof::bandwidth {

bool Plan::lacks_room() const {
  return !network.non_real_time.empty() && traffic.non_real_time_packet == kernel::Duration::zero();
}

bool Plan::keeps_bounds() const {
  for (std::size_t n = 0; n < demand.bounds.size(); ++n) {
    if (proof->longest_loop_delays[n] > demand.bounds[n]) return false;
  }
  return true;
}

bool Plan::keeps_slot() const {
  return proof->slowest_own <= traffic.slot;
}

bool Plan::is_stable() const {
  return stability.is_stable() && !proof->has_growing_queues;
}

bool Plan::is_proven() const {
  return proof && !lacks_room() && proof->holds() && keeps_slot() && keeps_bounds() && is_stable();
}

Plan plan_bandwidth(const Network& network, std::uint64_t seed) {
  Plan plan{.network = network, .seed = seed};
  plan.demand = network.demand();
  plan.allocation = allocate(plan.demand);
  plan.traffic = network.traffic(plan.allocation);
  check(plan.traffic);
  plan.stability = stability(plan.traffic, plan.allocation);
  if (plan.allocation.is_feasible()) {
    plan.proof = prove(plan.traffic, seed);
  } else {
    plan.remedy = remedy(plan.demand, plan.allocation);
  }
  return plan;
}

}  // namespace fieldproof::bandwidth
