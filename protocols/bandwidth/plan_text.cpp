// What a plan of the bandwidth says to people.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/kernel/untrusted_text.hpp"
#include "harness/traffic/milliseconds.hpp"
#include "protocols/bandwidth/plan.hpp"

namespace fieldproof::bandwidth {
namespace {

using kernel::describe;
using kernel::Duration;
using traffic::ms;

constexpr std::size_t kMostSlotsShown = 64;

std::string network_text(const Plan& plan) {
  const Network& network = plan.network;
  std::string text = fmt::format(
      "{}: {} control loops, {} nodes, {}, rule {}, seed {}\n"
      "server {} at a node, packets: periodic {}, real-time {}, non-real-time {} ({})\n",
      kernel::escaped_line(network.name), network.loops.size(), network.nodes, text_of(network.access),
      text_of(network.rule), plan.seed, describe(plan.demand.overhead), describe(network.periodic_packet),
      describe(network.real_time_packet), describe(plan.traffic.non_real_time_packet),
      plan.traffic.non_real_time_packet == Duration::zero() ? "none fits"
      : network.non_real_time_packet > Duration::zero()
          ? "of the file"
          : fmt::format("the longest by the {} bound", text_of(network.length_rule)));
  return text;
}

std::string loops_text(const Plan& plan) {
  std::string text = fmt::format("\n{:>4}  {:>12}  {:>12}  {:>5}  {:>14}  {:>14}  {}\n", "loop", "bound ms",
                                 "T ms", "slots", "sensor at", "controller at", "loop delay ms");
  for (std::size_t n = 0; n < plan.allocation.loops.size(); ++n) {
    const LoopShare& share = plan.allocation.loops[n];
    const LoopDescription& loop = plan.network.loops[n];
    text += fmt::format(
        "{:>4}  {:>12.3f}  {:>12.3f}  {:>5}  {:>14}  {:>14}  at most {:.3f}\n", n + 1, ms(loop.bound),
        ms(share.period), share.every, fmt::format("{} (node {})", share.sensor_offset, loop.sensor),
        fmt::format("{} (node {})", share.controller_offset, loop.controller), ms(share.longest_delay));
  }
  return text;
}

std::string slots_text(const Allocation& allocation) {
  const std::size_t shown = std::min(allocation.loads.size(), kMostSlotsShown);
  const std::vector<unsigned> first(allocation.loads.begin(),
                                    allocation.loads.begin() + static_cast<std::ptrdiff_t>(shown));
  return fmt::format(
      "\nslot T_1 {:.3f} ms; data of each slot {}{}; {:g} in the mean, {} to {}; windows needed {}, room for "
      "{}\n"
      "periodic interval at most {:.3f} ms, of it the server {:.3f} ms\n",
      ms(allocation.slot), fmt::join(first, " "), shown < allocation.loads.size() ? " ..." : "",
      allocation.mean_load(), allocation.fewest, allocation.windows, allocation.windows,
      std::max<std::int64_t>(allocation.most_windows, 0), ms(allocation.periodic_interval),
      ms(allocation.rotation));
}

std::string length_text(Duration length) {
  return length > Duration::zero() ? fmt::format("{:.3f} ms", ms(length)) : "none";
}

std::string limits_text(const Plan& plan) {
  const Allocation& allocation = plan.allocation;
  return fmt::format(
      "non-real-time packets: safe up to {}; {} as the paper prints it; {} where the first slots, in which\n"
      "controllers still wait, shall keep T_1 as well; {} where real-time packets shall at any time\n",
      length_text(allocation.longest_safe), length_text(allocation.longest_printed),
      length_text(allocation.longest_from_start), length_text(allocation.longest_for_real_time));
}

std::string stability_text(const Plan& plan) {
  const Stability& found = plan.stability;
  std::string text =
      fmt::format("load {:.4f}: periodic {:.4f}, real-time {:.4f}, non-real-time {:.4f}, server {:.4f}: {}\n",
                  found.load(), found.periodic, found.real_time, found.non_real_time, found.server,
                  found.is_stable() ? "queues are stable" : "queues grow without end");
  if (!plan.traffic.non_real_time.empty() && found.saturated_packets > 0) {
    text += fmt::format(
        "a non-real-time queue sends up to {:.4f} packets in a slot: one each {}\n", found.saturated_packets,
        describe(Duration{static_cast<std::int64_t>(static_cast<double>(plan.allocation.slot.count()) /
                                                    found.saturated_packets)} /
                 kernel::kMicrosecond * kernel::kMicrosecond));
  }
  return text;
}

std::string remedy_text(const Plan& plan) {
  const Allocation& allocation = plan.allocation;
  const Remedy& remedy = *plan.remedy;
  const Duration lack = allocation.periodic_interval - allocation.slot;
  std::string text = fmt::format(
      "\nnot feasible: loop {} makes the slot {:.3f} ms, a third of its bound; {} data, the real-time "
      "packets and the "
      "server need {:.3f} ms, {:.3f} ms more\nwhat would help, each alone:\n",
      remedy.fastest + 1, ms(allocation.slot), allocation.windows, ms(allocation.periodic_interval),
      ms(lack));
  if (remedy.bound) {
    text += fmt::format("  a bound of loop {} of {:.3f} ms instead of {:.3f} ms\n", remedy.fastest + 1,
                        ms(*remedy.bound), ms(plan.demand.bounds[remedy.fastest]));
  }
  if (remedy.periodic_packet) {
    text += fmt::format("  periodic packets of at most {} instead of {}\n", describe(*remedy.periodic_packet),
                        describe(plan.demand.periodic_packet));
  }
  if (remedy.overhead) {
    text += fmt::format("  a server that takes at most {} at a node instead of {}\n",
                        describe(*remedy.overhead), describe(plan.demand.overhead));
  }
  if (remedy.loops_to_leave_out < plan.demand.bounds.size()) {
    text += fmt::format(
        "  to leave out the {} with the least bound\n",
        remedy.loops_to_leave_out == 1 ? "loop" : fmt::format("{} loops", remedy.loops_to_leave_out));
  }
  return text;
}

std::string run_text(const ProofRun& run) {
  const WindowFigures& figures = run.figures;
  return fmt::format("  {:<34} {:<6} {:>8} {:>12.3f} {:>8} {:>8} {:>8}\n", run.name,
                     run.is_own_order ? "own" : "worst", figures.slots, ms(figures.longest()),
                     figures.over_slot(), figures.lost(), figures.vacant());
}

std::string proof_text(const Plan& plan) {
  const Proof& proof = *plan.proof;
  std::string text = fmt::format("\n  {:<34} {:<6} {:>8} {:>12} {:>8} {:>8} {:>8}\n", "simulated against",
                                 "order", "slots", "longest ms", "over T_1", "lost", "vacant");
  for (const ProofRun& run : proof.runs) text += run_text(run);
  text += fmt::format(
      "longest delay of a datum in closed form, while each slot keeps T_1: {:.3f} ms in this order of nodes, "
      "{:.3f} ms in the worst\n",
      ms(proof.slowest_own), ms(proof.slowest_of_all));
  for (const ProofRun& run : proof.runs) {
    if (!run.figures.first_late) continue;
    text += fmt::format("first over T_1 ({}, {} order): {}\n", run.name, run.is_own_order ? "own" : "worst",
                        story_of_late(run));
    break;
  }
  for (std::size_t n = 0; n < proof.longest_loop_delays.size(); ++n) {
    text += fmt::format("{}{:.3f} of {:.3f} ms", n == 0 ? "longest loop delays: " : ", ",
                        ms(proof.longest_loop_delays[n]), ms(plan.demand.bounds[n]));
  }
  return text + "\n";
}

bool is_off_grid(const Network& network) {
  return std::ranges::any_of(network.loops,
                             [](const LoopDescription& loop) { return loop.skew > Duration::zero(); });
}

std::string verdict_text(const Plan& plan) {
  const Proof& proof = *plan.proof;
  if (plan.lacks_room()) return "\nnot proven: the slot has no room for a non-real-time packet\n";
  if (!proof.holds() || !plan.keeps_slot() || !plan.keeps_bounds()) {
    std::string text = "\nnot proven: ";
    if (is_off_grid(plan.network)) {
      text +=
          "controllers sample off the grid of the slots; with a skew of 0 each sampling has one new datum\n";
    } else if (plan.traffic.non_real_time_packet > plan.allocation.longest_safe) {
      text +=
          fmt::format("non-real-time packets of {} are too long; {} hold\n",
                      describe(plan.traffic.non_real_time_packet), length_text(plan.allocation.longest_safe));
    } else {
      text += "see above\n";
    }
    return text;
  }
  if (!plan.is_stable()) {
    return "\nnot proven: data keep T_1 and their bounds, and other queues grow without end; larger gaps or "
           "fewer queues help\n";
  }
  std::string text = fmt::format(
      "\nproven by {} simulated slots: from slot {} on each datum goes within T_1, none is lost, no "
      "controller "
      "samples in vain, each loop keeps its bound; before, the longest delay was {:.3f} ms\n",
      proof.slots(), slots_of_start(plan.traffic) + 1, ms(proof.longest_of_start()));
  if (!proof.holds_in_any_order()) text += "another order of nodes would not keep T_1\n";
  return text;
}

}  // namespace

std::string plan_text(const Plan& plan) {
  std::string text = network_text(plan) + loops_text(plan) + slots_text(plan.allocation);
  if (plan.remedy) return text + remedy_text(plan);
  return text + limits_text(plan) + stability_text(plan) + proof_text(plan) + verdict_text(plan);
}

}  // namespace fieldproof::bandwidth
