#include "protocols/fieldbus_dll/target_plan_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "harness/kernel/error.hpp"
#include "harness/kernel/untrusted_text.hpp"
#include "harness/traffic/milliseconds.hpp"
#include "harness/traffic/urgent_delay.hpp"
#include "protocols/fieldbus_dll/token_network.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using traffic::ms;

std::string text_of_bound(const DelayBound& bound) {
  const double limit = ms(bound.at_most);
  if (!bound.share) return fmt::format("mean delay of urgent packets of each node at most {:g} ms", limit);
  return fmt::format("{:g} % of the urgent packets of each node within {:g} ms", 100 * *bound.share, limit);
}

std::string reached_text(const TargetRun& run, const DelayBound& bound) {
  const std::string node = fmt::format("at node {}, the worst", run.worst_node + 1);
  if (bound.share) return fmt::format("{:.4f} % (+- {:.4f}) {}", 100 * run.reached, 100 * run.error, node);
  return fmt::format("mean {:.4f} ms (+- {:.4f}) {}", run.reached, run.error, node);
}

std::string met_text(const TargetRun& run) {
  if (run.meets_bound) return "met";
  return run.fewest > 0 ? "not met" : "not met: a node with urgent packets sent none";
}

std::string searched_text(const TargetPlan& plan, const DelayBound& bound) {
  std::string text = fmt::format("\n{:>12}  {:>12}  {:>16}  {}\n", "TTRT ms",
                                 bound.share ? "within %" : "mean ms", "time-avail. ms", "bound");
  for (const TargetRun& run : plan.searched) {
    const auto& rest = run.figures.all[traffic::kTimeAvailable];
    text += fmt::format(
        "{:>12.3f}  {:>12.4f}  {:>16}  {}\n", ms(run.target), bound.share ? 100 * run.reached : run.reached,
        rest.is_unstable ? "unstable" : fmt::format("{:.3f}", rest.mean_delay), met_text(run));
  }
  return text;
}

std::string priorities_text(const TargetRun& run) {
  std::string text;
  for (unsigned p = 0; p < traffic::kTokenPriorities; ++p) {
    const auto& all = run.figures.all[p];
    const char* const name = name_of(static_cast<traffic::TokenPriority>(p));
    if (!all.is_unstable && all.packets > 0) {
      text += fmt::format("  {:<15} mean {:.4f} ms (+- {:.4f}), largest {:.3f} ms, {} packets\n", name,
                          all.mean_delay, 1.96 * all.standard_error, all.largest_delay, all.packets);
    }
    for (std::size_t n = 0; n < run.figures.nodes.size(); ++n) {
      const auto& stream = run.figures.nodes[n][p];
      if (!stream.is_unstable) continue;
      text += fmt::format(
          "  warning: the {} queue of node {} grows without end: {:.3f} packets come in a second, the "
          "token carries {:.3f}\n",
          name, n + 1, 1e3 * stream.arrive_per_ms, 1e3 * stream.leave_per_ms);
    }
  }
  return text + fmt::format("  {:<15} mean {:.4f} ms, {} of them\n", "rotations", run.figures.mean_rotation,
                            run.figures.rotations);
}

bool has_model(const traffic::TokenTraffic& traffic) {
  const auto& first = traffic.nodes.front();
  const bool has_its_rule = traffic.rule == traffic::TokenRule::all_or_urgent;
  return has_its_rule && traffic.schedule.empty() &&
         std::ranges::all_of(traffic.nodes, [&](const auto& node) {
           if (node.overhead != first.overhead || node.streams[traffic::kNormal].per_ms > 0) return false;
           return std::ranges::equal(node.streams, first.streams, [](const auto& a, const auto& b) {
             return a.per_ms == b.per_ms && a.length == b.length;
           });
         });
}

std::string model_text(const traffic::TokenTraffic& traffic, kernel::Duration target) {
  if (!has_model(traffic))
    return "  model           none: it has equal nodes, two priorities, tokens for all or urgent data, no "
           "schedule\n";
  const auto& streams = traffic.nodes.front().streams;
  traffic::UrgentTraffic equal;
  const auto& available = streams[traffic::kTimeAvailable];
  equal.urgent_queues = equal.available_queues = static_cast<unsigned>(traffic.nodes.size());
  equal.urgent_length = streams[traffic::kUrgent].length;
  equal.urgent_per_ms = streams[traffic::kUrgent].per_ms;
  // Without packets their length is of no matter, and has to be one.
  equal.available_length = available.per_ms > 0 ? available.length : equal.urgent_length;
  equal.available_per_ms = available.per_ms;
  equal.empty_rotation = traffic.empty_rotation();
  equal.target_rotation = target;
  traffic::UrgentDelay model;
  try {
    model = traffic::urgent_delay(equal);
  } catch (const kernel::Error& error) {
    return fmt::format("  model           none: {}\n", error.what());
  }
  if (equal.load() >= 1) return "  model           none: it has loads under 1\n";
  if (model.is_urgent_unstable) return "  model           no stationary state: urgent queues grow\n";
  if (model.is_available_saturated)
    return "  model           no stationary state: time-available queues grow\n";
  return fmt::format("  model           mean delay of urgent packets {:.4f} ms (Hong and Son, (26))\n",
                     model.delay);
}

// What the worst node does not say.
std::string why_not_text(const TargetRun& tried) {
  if (tried.meets_bound) return "; time-available queues grow";
  if (tried.fewest >= kFewPackets) return "";
  return fmt::format("; a node sent {} packets, too few to know", tried.fewest);
}

}  // namespace

std::string plan_text(const TargetPlan& plan, const TokenNetwork& network) {
  std::string text = searched_text(plan, network.bound);
  if (plan.is_proven) {
    const TargetRun& chosen = plan.tried.back();
    return text + fmt::format("\nTTRT {:.3f} ms, proven by a longer simulation with another seed: {}\n{}{}",
                              ms(chosen.target), reached_text(chosen, network.bound), priorities_text(chosen),
                              model_text(network.traffic, chosen.target));
  }
  const TargetRun& best = plan.searched[plan.best];
  for (const TargetRun& tried : plan.tried) {
    text += fmt::format("\nTTRT {:.3f} ms does not stand a longer simulation: {}{}", ms(tried.target),
                        reached_text(tried, network.bound), why_not_text(tried));
  }
  return text + fmt::format("\nno TTRT is proven to meet the bound{}; the best is {:.3f} ms: {}\n{}",
                            plan.is_open
                                ? ", and none is refuted: the simulations end with too few packets of a "
                                  "node, or too close to the bound; give it more packets per_s, or "
                                  "another bound"
                                : "",
                            ms(best.target), reached_text(best, network.bound), priorities_text(best));
}

std::string network_text(const TokenNetwork& network, std::uint64_t seed) {
  return fmt::format("{}: {} nodes, empty rotation {:g} ms, load {:.4f}, schedule {:.4f}, seed {}\n{}\n",
                     kernel::escaped_line(network.name), network.traffic.nodes.size(),
                     ms(network.traffic.empty_rotation()), network.traffic.load(),
                     network.traffic.scheduled_load(), seed, text_of_bound(network.bound));
}

}  // namespace fieldproof::fieldbus_dll
