#include "protocols/fieldbus_dll/target_plan.hpp"

#include <algorithm>
#include <cmath>

#include "harness/kernel/random.hpp"
#include "harness/traffic/milliseconds.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using traffic::ms;

constexpr double kHalfWidth95 = 1.96;
constexpr std::size_t kFewBatches = 20;  // that prove nothing of a standard error

// What no rotation reaches: each queue sends, and so do all items of the macrocycles that it touches.
kernel::Duration unreachable(const traffic::TokenTraffic& traffic) {
  kernel::Duration longest = traffic.empty_rotation();
  for (const traffic::TokenNode& node : traffic.nodes) {
    for (const traffic::PacketStream& stream : node.streams) longest += stream.length;
  }
  // Each visit and each packet may wait for items; after that many macrocycles all of them had their gap.
  if (!traffic.schedule.empty()) longest += static_cast<int>(traffic.nodes.size() + 1) * traffic.macrocycle;
  return longest + kernel::kPicosecond;
}

// A rotation that equals its target is too long: the first value admits nothing, the last one everything.
std::vector<kernel::Duration> targets_of(const traffic::TokenTraffic& traffic,
                                         const traffic::TrafficRun& search) {
  traffic::TokenTraffic free = traffic;
  free.target = unreachable(traffic);
  const double longest = traffic::pass_token(free, search).longest_rotation;
  const kernel::Duration shortest = traffic.empty_rotation();
  // Whole microseconds: what is told is what was proven.
  const auto whole = [](kernel::Duration target) {
    return target / kernel::kMicrosecond * kernel::kMicrosecond;
  };
  const auto range =
      kernel::Duration{static_cast<std::int64_t>(longest * traffic::kPicosecondsPerMs)} - shortest;
  std::vector<kernel::Duration> targets;
  for (unsigned n = 0; n + 1 < kTargets; ++n) {
    targets.push_back(whole(shortest + n * (std::max(range, kernel::Duration::zero()) / (kTargets - 2))));
  }
  targets.push_back(whole(free.target + kernel::kMicrosecond));
  return targets;
}

enum class Judges { search, proof };

bool is_worse(double one, double other, bool is_share) {
  return is_share ? one < other : one > other;
}

// What is held with 95 %: the mean or the share, and what it is off by at most.
double held(const traffic::StreamFigures& urgent, bool is_share, Judges judges) {
  const bool is_proof = judges == Judges::proof;
  if (is_share) return is_proof ? urgent.least_within : urgent.within;
  return urgent.mean_delay + (is_proof ? kHalfWidth95 * urgent.standard_error : 0);
}

// Whatever its half width holds, or with queues that grow.
bool is_refuted(const traffic::StreamFigures& urgent, const DelayBound& bound, double half_width) {
  if (urgent.packets == 0) return false;
  if (urgent.is_unstable) return true;
  return bound.share ? urgent.within + half_width < *bound.share
                     : urgent.mean_delay - half_width > ms(bound.at_most);
}

TargetRun judged(kernel::Duration target, traffic::TrafficFigures figures, const DelayBound& bound,
                 Judges judges) {
  TargetRun run{.target = target, .figures = std::move(figures)};
  const bool is_share = bound.share.has_value();
  std::optional<double> worst;
  bool is_met = true;
  bool is_refuted_somewhere = false;
  for (std::size_t n = 0; n < run.figures.nodes.size(); ++n) {
    const traffic::StreamFigures& urgent = run.figures.nodes[n][traffic::kUrgent];
    if (urgent.arrive_per_ms == 0) continue;
    const double this_one = held(urgent, is_share, judges);
    const double half_width = std::abs(this_one - (is_share ? urgent.within : urgent.mean_delay));
    is_refuted_somewhere |= is_refuted(urgent, bound, half_width);
    is_met &= !urgent.is_unstable && urgent.packets > 0;
    is_met &= is_share ? this_one >= *bound.share : this_one <= ms(bound.at_most);
    if (judges == Judges::proof) is_met &= urgent.packets >= kFewPackets && urgent.batches >= kFewBatches;
    run.fewest = worst ? std::min(run.fewest, urgent.packets) : urgent.packets;
    if (worst && !is_worse(this_one, *worst, is_share)) continue;
    worst = this_one;
    run.worst_node = n;
    run.reached = is_share ? urgent.within : urgent.mean_delay;
    run.error = std::abs(this_one - run.reached);
  }
  run.meets_bound = worst && is_met;
  run.is_open = !run.meets_bound && !is_refuted_somewhere;
  return run;
}

// Time-available packets that leave all nodes in a millisecond.
double carried(const TargetRun& run) {
  double sum = 0;
  for (const auto& node : run.figures.nodes) sum += node[traffic::kTimeAvailable].leave_per_ms;
  return sum;
}

bool harms_less(const TargetRun& one, const TargetRun& other) {
  const traffic::StreamFigures& a = one.figures.all[traffic::kTimeAvailable];
  const traffic::StreamFigures& b = other.figures.all[traffic::kTimeAvailable];
  if (a.is_unstable != b.is_unstable) return b.is_unstable;
  return a.is_unstable ? carried(one) > carried(other) : a.mean_delay < b.mean_delay;
}

bool is_tie(const TargetRun& one, const TargetRun& best) {
  const traffic::StreamFigures& a = one.figures.all[traffic::kTimeAvailable];
  const traffic::StreamFigures& b = best.figures.all[traffic::kTimeAvailable];
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

// Of those in which each node has sent something, if there is one.
std::size_t best_of(const std::vector<TargetRun>& searched, bool is_share) {
  std::size_t best = 0;
  for (std::size_t n = 1; n < searched.size(); ++n) {
    const bool has_more = searched[best].fewest == 0 && searched[n].fewest > 0;
    const bool has_less = searched[best].fewest > 0 && searched[n].fewest == 0;
    if (has_more || (!has_less && is_worse(searched[best].reached, searched[n].reached, is_share))) best = n;
  }
  return best;
}

bool begins_to_grow(const TargetRun& searched, const TargetRun& longer) {
  return !searched.figures.all[traffic::kTimeAvailable].is_unstable &&
         longer.figures.all[traffic::kTimeAvailable].is_unstable;
}

// Packets that a proof counts: half of what its visits take, if that is less, so that its batches are full.
std::uint64_t packets_of_proof(const traffic::TrafficFigures& searched, const traffic::TrafficRun& proof) {
  double packets = 0;
  for (const auto& node : searched.nodes) packets += static_cast<double>(node[traffic::kUrgent].packets);
  const double rotations = static_cast<double>(proof.visits) / static_cast<double>(searched.nodes.size());
  const double most =
      searched.rotations > 0 ? packets / static_cast<double>(searched.rotations) * rotations : 0;
  return std::clamp(static_cast<std::uint64_t>(most / 2), kFewPackets, proof.urgent_packets);
}

}  // namespace

TargetPlan plan_target(const traffic::TokenTraffic& traffic, const DelayBound& bound, std::uint64_t seed) {
  traffic::TrafficRun search{.urgent_packets = 100'000, .warm_up_rotations = 2'000, .visits = 2'000'000};
  search.seed = kernel::Random(seed).split("search").seed();
  search.bound = bound.at_most;
  traffic::TrafficRun proof{.urgent_packets = 1'000'000, .warm_up_rotations = 10'000, .visits = 20'000'000};
  proof.seed = kernel::Random(seed).split("proof").seed();
  proof.bound = bound.at_most;

  check(traffic);
  TargetPlan plan;
  traffic::TokenTraffic tried = traffic;
  for (const kernel::Duration target : targets_of(traffic, search)) {
    tried.target = target;
    plan.searched.push_back(judged(target, traffic::pass_token(tried, search), bound, Judges::search));
  }
  plan.best = best_of(plan.searched, bound.share.has_value());
  const TargetRun* last = nullptr;
  for (const TargetRun* candidate : candidates(plan.searched)) {
    if (plan.tried.size() == kMostProofs) break;
    // The same rotations: the target parts none of them.
    if (last != nullptr && last->figures.mean_rotation == candidate->figures.mean_rotation) continue;
    last = candidate;
    tried.target = candidate->target;
    traffic::TrafficRun longer = proof;
    longer.urgent_packets = packets_of_proof(candidate->figures, proof);
    plan.tried.push_back(judged(tried.target, traffic::pass_token(tried, longer), bound, Judges::proof));
    plan.is_proven = plan.tried.back().meets_bound && !begins_to_grow(*candidate, plan.tried.back());
    if (plan.is_proven) break;
  }
  const bool is_any_open = std::ranges::any_of(plan.tried, &TargetRun::is_open);
  plan.is_open = !plan.is_proven && (plan.tried.empty() ? plan.searched[plan.best].is_open : is_any_open);
  return plan;
}

}  // namespace fieldproof::fieldbus_dll
