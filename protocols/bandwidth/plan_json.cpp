// A plan of the bandwidth as a document. Durations are whole picoseconds.
#include <nlohmann/json.hpp>

#include "protocols/bandwidth/plan.hpp"

namespace fieldproof::bandwidth {
namespace {

using nlohmann::ordered_json;

ordered_json loops_of(const Plan& plan) {
  ordered_json loops = ordered_json::array();
  for (std::size_t n = 0; n < plan.allocation.loops.size(); ++n) {
    const LoopShare& share = plan.allocation.loops[n];
    ordered_json loop{{"bound_ps", plan.demand.bounds[n].count()},
                      {"period_ps", share.period.count()},
                      {"every", share.every},
                      {"sensor_offset", share.sensor_offset},
                      {"controller_offset", share.controller_offset},
                      {"longest_delay_ps", share.longest_delay.count()}};
    if (plan.proof) loop["simulated_delay_ps"] = plan.proof->longest_loop_delays[n].count();
    loops.push_back(std::move(loop));
  }
  return loops;
}

ordered_json limits_of(const Allocation& allocation) {
  return {{"safe_ps", allocation.longest_safe.count()},
          {"printed_ps", allocation.longest_printed.count()},
          {"from_start_ps", allocation.longest_from_start.count()},
          {"real_time_ps", allocation.longest_for_real_time.count()}};
}

ordered_json stability_of(const Stability& found) {
  return {{"periodic", found.periodic},           {"real_time", found.real_time},
          {"non_real_time", found.non_real_time}, {"server", found.server},
          {"is_stable", found.is_stable()},       {"saturated_packets", found.saturated_packets}};
}

ordered_json remedy_of(const Remedy& remedy) {
  ordered_json json{{"fastest_loop", remedy.fastest + 1}, {"loops_to_leave_out", remedy.loops_to_leave_out}};
  if (remedy.bound) json["bound_ps"] = remedy.bound->count();
  if (remedy.periodic_packet) json["periodic_packet_ps"] = remedy.periodic_packet->count();
  if (remedy.overhead) json["overhead_ps"] = remedy.overhead->count();
  return json;
}

ordered_json proof_of(const Proof& proof) {
  ordered_json runs = ordered_json::array();
  for (const ProofRun& run : proof.runs) {
    ordered_json one{{"against", run.name},
                     {"order", run.is_own_order ? "own" : "worst"},
                     {"slots", run.figures.slots},
                     {"longest_ps", run.figures.longest().count()},
                     {"over_slot", run.figures.over_slot()},
                     {"lost", run.figures.lost()},
                     {"vacant", run.figures.vacant()}};
    if (run.figures.first_late) one["first_late"] = story_of_late(run);
    runs.push_back(std::move(one));
  }
  return {{"slowest_ps", proof.slowest_own.count()},
          {"slowest_of_any_order_ps", proof.slowest_of_all.count()},
          {"longest_of_start_ps", proof.longest_of_start().count()},
          {"runs", std::move(runs)}};
}

}  // namespace

std::string plan_json(const Plan& plan) {
  const Allocation& allocation = plan.allocation;
  ordered_json json{{"schema", "fieldproof/bandwidth_plan/1"},
                    {"network", plan.network.name},
                    {"seed", plan.seed},
                    {"rule", text_of(plan.network.rule)},
                    {"is_feasible", allocation.is_feasible()},
                    {"is_proven", plan.is_proven()},
                    {"slot_ps", allocation.slot.count()},
                    {"loads", allocation.loads},
                    {"windows", allocation.windows},
                    {"fewest", allocation.fewest},
                    {"most_windows", allocation.most_windows},
                    {"rotation_ps", allocation.rotation.count()},
                    {"periodic_interval_ps", allocation.periodic_interval.count()},
                    {"non_real_time_packet_ps", plan.traffic.non_real_time_packet.count()},
                    {"longest_packets", limits_of(allocation)},
                    {"loops", loops_of(plan)},
                    {"stability", stability_of(plan.stability)}};
  if (plan.remedy) json["remedy"] = remedy_of(*plan.remedy);
  if (plan.proof) json["proof"] = proof_of(*plan.proof);
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fieldproof::bandwidth
