#include "protocols/fieldbus_dll/target_plan.hpp"

#include <algorithm>
#include <cmath>

#include "harness/kernel/random.hpp"
#include "protocols/fieldbus_dll/milliseconds.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr double kHalfWidth95 = 1.96;
constexpr std::uint64_t kFewPackets = 100;  // that prove nothing
constexpr std::size_t kFewBatches = 20;     // the same, of a standard error

// What no rotation reaches: each queue sends, and so do all items of the macrocycles that it touches.
kernel::Duration unreachable(const TokenTraffic& traffic) {
  kernel::Duration longest = traffic.empty_rotation();
  for (const TokenNode& node : traffic.nodes) {
    for (const PacketStream& stream : node.streams) longest += stream.length;
  }
  // Each visit and each packet may wait for items; behind that many macrocycles all of them had their gap.
  if (!traffic.schedule.empty()) longest += static_cast<int>(traffic.nodes.size() + 1) * traffic.macrocycle;
  return longest + kernel::kPicosecond;
}

// A rotation that equals its target is too long: the first value admits nothing, the last one everything.
std::vector<kernel::Duration> targets_of(const TokenTraffic& traffic, const TrafficRun& search) {
  TokenTraffic free = traffic;
  free.target = unreachable(traffic);
  const double longest = pass_token(free, search).longest_rotation;
  const kernel::Duration shortest = traffic.empty_rotation();
  const auto range = kernel::Duration{static_cast<std::int64_t>(longest * kPicosecondsPerMs)} - shortest;
  std::vector<kernel::Duration> targets;
  for (unsigned n = 0; n + 1 < kTargets; ++n) {
    targets.push_back(shortest + n * (std::max(range, kernel::Duration::zero()) / (kTargets - 2)));
  }
  targets.push_back(free.target);
  return targets;
}

bool is_worse(double one, double other, bool is_share) {
  return is_share ? one < other : one > other;
}

TargetRun judged(kernel::Duration target, TrafficFigures figures, const DelayBound& bound, double width) {
  TargetRun run{.target = target, .figures = std::move(figures)};
  bool has_node = false;
  bool is_unstable = false;
  bool has_error = true;
  std::uint64_t fewest = ~std::uint64_t{0};
  for (std::size_t n = 0; n < run.figures.nodes.size(); ++n) {
    const StreamFigures& urgent = run.figures.nodes[n][kUrgent];
    if (urgent.arrive_per_ms == 0) continue;
    is_unstable |= urgent.is_unstable;
    fewest = std::min(fewest, urgent.packets);
    has_error &= urgent.batches >= kFewBatches;
    const double reached = bound.share ? urgent.within : urgent.mean_delay;
    if (has_node && !is_worse(reached, run.reached, bound.share.has_value())) continue;
    has_node = true;
    run.worst_node = n;
    run.reached = reached;
    run.error = width * (bound.share ? urgent.within_error : urgent.standard_error);
  }
  const bool is_within =
      bound.share ? run.reached - run.error >= *bound.share : run.reached + run.error <= ms(bound.at_most);
  run.meets_bound = !is_unstable && fewest >= kFewPackets && is_within && (width == 0 || has_error);
  return run;
}

// Time-available packets that leave all nodes in a millisecond.
double carried(const TargetRun& run) {
  double sum = 0;
  for (const auto& node : run.figures.nodes) sum += node[kTimeAvailable].leave_per_ms;
  return sum;
}

bool harms_less(const TargetRun& one, const TargetRun& other) {
  const StreamFigures& a = one.figures.all[kTimeAvailable];
  const StreamFigures& b = other.figures.all[kTimeAvailable];
  if (a.is_unstable != b.is_unstable) return b.is_unstable;
  return a.is_unstable ? carried(one) > carried(other) : a.mean_delay < b.mean_delay;
}

bool is_tie(const TargetRun& one, const TargetRun& best) {
  const StreamFigures& a = one.figures.all[kTimeAvailable];
  const StreamFigures& b = best.figures.all[kTimeAvailable];
  if (a.is_unstable || b.is_unstable) return a.is_unstable == b.is_unstable && carried(one) == carried(best);
  return a.mean_delay - b.mean_delay <= b.standard_error;
}

// What to prove, in order.
std::vector<const TargetRun*> candidates(const std::vector<TargetRun>& searched) {
  std::vector<const TargetRun*> order;
  for (const TargetRun& run : searched) {
    if (run.meets_bound) order.push_back(&run);
  }
  std::ranges::stable_sort(order, [](auto* a, auto* b) { return harms_less(*a, *b); });
  if (order.empty()) return order;
  const TargetRun best = *order.front();
  const auto rest = std::ranges::stable_partition(order, [&](auto* run) { return is_tie(*run, best); });
  std::ranges::sort(order.begin(), rest.begin(), [](auto* a, auto* b) { return a->target > b->target; });
  return order;
}

// Packets that a proof counts: half of what its visits take, if that is less, so that its batches are full.
std::uint64_t packets_of_proof(const TrafficFigures& searched, const TrafficRun& proof) {
  double packets = 0;
  for (const auto& node : searched.nodes) packets += static_cast<double>(node[kUrgent].packets);
  const double rotations = static_cast<double>(proof.visits) / static_cast<double>(searched.nodes.size());
  const double most =
      searched.rotations > 0 ? packets / static_cast<double>(searched.rotations) * rotations : 0;
  return std::clamp(static_cast<std::uint64_t>(most / 2), kFewPackets, proof.urgent_packets);
}

}  // namespace

TargetPlan plan_target(const TokenTraffic& traffic, const DelayBound& bound, std::uint64_t seed) {
  TrafficRun search{.urgent_packets = 100'000, .warm_up_rotations = 2'000, .visits = 2'000'000};
  search.seed = kernel::Random(seed).split("search").seed();
  search.bound = bound.at_most;
  TrafficRun proof{.urgent_packets = 1'000'000, .warm_up_rotations = 10'000, .visits = 20'000'000};
  proof.seed = kernel::Random(seed).split("proof").seed();
  proof.bound = bound.at_most;

  check(traffic);
  TargetPlan plan;
  TokenTraffic tried = traffic;
  for (const kernel::Duration target : targets_of(traffic, search)) {
    tried.target = target;
    plan.searched.push_back(judged(target, pass_token(tried, search), bound, 0));
    if (is_worse(plan.searched[plan.best].reached, plan.searched.back().reached, bound.share.has_value())) {
      plan.best = plan.searched.size() - 1;
    }
  }
  for (const TargetRun* candidate : candidates(plan.searched)) {
    if (plan.tried.size() == kMostProofs) break;
    tried.target = candidate->target;
    TrafficRun longer = proof;
    longer.urgent_packets = packets_of_proof(candidate->figures, proof);
    plan.tried.push_back(judged(tried.target, pass_token(tried, longer), bound, kHalfWidth95));
    plan.is_proven = plan.tried.back().meets_bound;
    if (plan.is_proven) break;
  }
  return plan;
}

}  // namespace fieldproof::fieldbus_dll
