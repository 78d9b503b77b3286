#include "reports/trace_json.hpp"

#include <nlohmann/json.hpp>

namespace fieldproof::reports {
namespace {

using Json = nlohmann::ordered_json;

double microseconds(kernel::Duration duration) {
  return static_cast<double>(duration.count()) * 1e-6;
}

Json edges_json(const std::vector<measure::Trace::Edge>& edges) {
  Json json = Json::array();
  for (const auto& edge : edges)
    json.push_back({{"time_us", microseconds(edge.when)}, {"level", edge.level}});
  return json;
}

}  // namespace

Json trace_json(const measure::Trace& trace) {
  return {{"length_us", microseconds(trace.length)},
          {"input", edges_json(trace.input)},
          {"output", edges_json(trace.output)}};
}

}  // namespace fieldproof::reports
