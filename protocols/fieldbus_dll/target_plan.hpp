#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/traffic/token_traffic.hpp"

// The target rotation time (TTRT) that keeps a bound of urgent delays with the least harm to time-available
// data.
//
// A TTRT matters only where it parts rotations that occur. kTargets values are simulated with one seed: from
// the empty rotation evenly to the longest one that occurs under a TTRT that none reaches, and that TTRT.
// Those that meet the bound are ordered:
// stable time-available queues first, by their mean delay; then by what they carry. What is within a standard
// error of the best is a tie, which goes to the larger TTRT. The first one of that order which a longer
// simulation with another seed also shows to meet the bound at each node, with 95 % confidence, and without
// time-available queues that grow where the search had none, is the plan.
namespace fieldproof::fieldbus_dll {

// For the urgent packets of each node that has some: their mean delay, or, with a share, the delay of this
// share of them.
struct DelayBound {
  kernel::Duration at_most{};
  std::optional<double> share{};  // over 0, under 1
};

struct TargetRun {
  kernel::Duration target{};
  traffic::TrafficFigures figures;
  std::size_t worst_node = 0;  // of urgent packets
  double reached = 0;          // by it: mean delay in ms, or share within the bound
  double error = 0;            // 95 % half width of it; 0 in a search
  std::uint64_t fewest = 0;    // packets of a node that has some
  bool meets_bound = false;    // at each node, with its half width, where there is one
  bool is_open = false;        // it is not shown to, nor that it does not: too few packets
};

struct TargetPlan {
  std::vector<TargetRun> searched;  // by target
  std::vector<TargetRun> tried;     // the longer simulations, in their order; the last one is the plan
  bool is_proven = false;
  // Not proven, and not refuted: of what was tried, or of the best that was searched, too little is known.
  bool is_open = false;
  std::size_t best = 0;  // of `searched`: which serves urgent packets best, whatever it costs
};

inline constexpr unsigned kTargets = 24;
inline constexpr std::uint64_t kFewPackets = 100;  // of a node, that prove nothing
inline constexpr unsigned kMostProofs = 4;

// Throws as `pass_token` does. `traffic.target` is not read.
TargetPlan plan_target(const traffic::TokenTraffic& traffic, const DelayBound& bound, std::uint64_t seed);

}  // namespace fieldproof::fieldbus_dll
