#include "papers/bandwidth_lines.hpp"

#include <fmt/format.h>

#include <utility>

#include "harness/traffic/milliseconds.hpp"
#include "protocols/bandwidth/sample_plans.hpp"

namespace fieldproof::papers {
namespace {

using bandwidth::Demand;
using bandwidth::Load;
using bandwidth::Packet;
using bandwidth::Sent;
using bandwidth::WindowFigures;
using bandwidth::WindowRun;
using bandwidth::WindowTraffic;
using kernel::Duration;
using reports::PublishedCurves;
using traffic::ms;

// The events of some slots of stations that send frames.
std::vector<Sent> frames_of(const WindowTraffic& traffic, const bandwidth::WindowLineRules& rules,
                            Load others, const Settings& settings) {
  WindowRun run{.seed = settings.seed, .slots = 8, .real_time = others, .non_real_time = others};
  return run_window_link(traffic, rules, run).sent;
}

}  // namespace

std::int64_t microseconds_of(Duration duration) {
  return duration / kernel::kMicrosecond;
}

Demand with_real_time() {
  Demand demand = bandwidth::fractional_density();
  demand.real_time_queues = 3;
  demand.real_time_packet = 200 * kernel::kMicrosecond;
  return demand;
}

WindowTraffic safe_traffic(const Demand& demand) {
  return bandwidth::traffic_of(demand, microseconds_of(allocate(demand).longest_safe));
}

std::string told_longest(const WindowFigures& figures) {
  return fmt::format("longest {:.3f} ms, {} over T_1 in {} slots", ms(figures.longest()), figures.over_slot(),
                     figures.slots);
}

bandwidth::WindowLineRules line_rules() {
  return {.real_time_octets = 12, .non_real_time_octets = 250};
}

WindowTraffic on_real_line(const Demand& demand) {
  return on_line(bandwidth::traffic_of(demand, 1), line_rules());
}

PublishedCurves figure_of_packets(std::string name, const Demand& demand, Load others, const Span& span,
                                  const Settings& settings) {
  const WindowTraffic traffic = on_real_line(demand);
  const std::vector<Sent> sent = frames_of(traffic, line_rules(), others, settings);
  const Duration slot = traffic.slot;
  PublishedCurves figure{std::move(name), "time, ms", "node", {}};
  const double from = static_cast<double>(span.first_slot) * ms(slot);
  const double to = from + span.slots * ms(slot);
  for (const Packet packet : {Packet::periodic, Packet::real_time, Packet::non_real_time}) {
    PublishedCurves::Curve curve{name_of(packet), {}};
    for (const Sent& one : sent) {
      const double begin = ms(one.begin - kernel::kStart);
      const double end = ms(one.end - kernel::kStart);
      if (one.packet != packet || begin < from || end > to) continue;
      const double node = one.node + 1.0;
      for (const auto& [x, y] : {std::pair{begin, 0.0}, {begin, node}, {end, node}, {end, 0.0}})
        curve.points.push_back({x, y});
    }
    if (!curve.points.empty()) figure.curves.push_back(std::move(curve));
  }
  return figure;
}

}  // namespace fieldproof::papers
