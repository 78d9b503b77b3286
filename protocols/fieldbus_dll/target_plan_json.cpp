// A plan of the target rotation time as a document. Durations are whole picoseconds, delays milliseconds.
#include <nlohmann/json.hpp>

#include "protocols/fieldbus_dll/target_plan_text.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using nlohmann::ordered_json;

ordered_json run_of(const TargetRun& run) {
  const traffic::StreamFigures& rest = run.figures.all[traffic::kTimeAvailable];
  ordered_json json{{"target_ps", run.target.count()},
                    {"worst_node", run.worst_node + 1},
                    {"reached", run.reached},
                    {"error", run.error},
                    {"meets_bound", run.meets_bound},
                    {"mean_rotation_ms", run.figures.mean_rotation},
                    {"is_time_available_unstable", rest.is_unstable}};
  if (!rest.is_unstable) json["time_available_delay_ms"] = rest.mean_delay;
  return json;
}

ordered_json runs_of(const std::vector<TargetRun>& runs) {
  ordered_json all = ordered_json::array();
  for (const TargetRun& run : runs) all.push_back(run_of(run));
  return all;
}

}  // namespace

std::string plan_json(const TargetPlan& plan, const TokenNetwork& network, std::uint64_t seed) {
  ordered_json bound{{"at_most_ps", network.bound.at_most.count()}};
  if (network.bound.share) bound["share"] = *network.bound.share;
  ordered_json json{{"schema", "fieldproof/target_plan/1"},
                    {"network", network.name},
                    {"seed", seed},
                    {"bound", std::move(bound)},
                    {"is_proven", plan.is_proven}};
  if (plan.is_proven) json["target_ps"] = plan.tried.back().target.count();
  json["searched"] = runs_of(plan.searched);
  json["tried"] = runs_of(plan.tried);
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fieldproof::fieldbus_dll
