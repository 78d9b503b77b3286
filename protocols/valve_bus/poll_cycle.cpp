#include "protocols/valve_bus/poll_cycle.hpp"

#include <algorithm>

#include "protocols/valve_bus/timing.hpp"

namespace fieldproof::valve_bus {
namespace {

using kernel::Duration;

// Waiting times settle within a few cycles, or alternate for ever.
constexpr int kMostCycles = 100;

// What a step finds: all of it as times since the first one.
class Walk {
 public:
  Walk(const Rules& rules, const std::vector<PolledNode>& nodes)
      : rules_(rules), nodes_(nodes), reported_(nodes.size()), ready_(nodes.size()) {}

  // When its first start bit comes.
  Duration begin(const PollStep& step) {
    const PolledNode& node = nodes_[step.node];
    asked_ = std::max(asked_, ready_[step.node]);
    if (step.copied_from) asked_ = std::max(asked_, reported_[*step.copied_from]);
    const Duration driver_on = bits(rules_, rules_.driver_on_bits);
    const Duration begin = std::max(free_, asked_) + driver_on;
    const Duration length = step.is_write ? reference_write_time(rules_, node.way)
                                          : reference_poll_time(rules_, node.way).total();
    free_ = begin + length - driver_on;
    if (!step.is_write) {
      reported_[step.node] = free_;
      ready_[step.node] = free_ + (node.is_written ? rest_of_exchange(rules_) : Duration{});
    }
    return begin;
  }

 private:
  const Rules& rules_;
  const std::vector<PolledNode>& nodes_;
  Duration free_{};                 // the line
  Duration asked_{};                // by the PC, in the order of the steps
  std::vector<Duration> reported_;  // by node: the last response
  std::vector<Duration> ready_;     // by node
};

}  // namespace

kernel::Duration rest_of_exchange(const Rules& rules) {
  return std::max(actuation_limit(rules) - rules.write_distance, Duration{});
}

PollCycle poll_cycle(const Rules& rules, const std::vector<PollStep>& steps,
                     const std::vector<PolledNode>& nodes) {
  Walk walk(rules, nodes);
  PollCycle cycle;
  std::optional<Duration> first;
  for (int n = 0; n < kMostCycles && !cycle.is_steady; ++n) {
    std::vector<Duration> begins;
    for (const PollStep& step : steps) begins.push_back(walk.begin(step));
    if (first) cycle.time = begins.front() - *first;
    cycle.longest = std::max(cycle.longest, cycle.time);
    first = begins.front();
    for (Duration& begin : begins) begin -= *first;
    // What a cycle is like follows from the one before it alone.
    cycle.is_steady = begins == cycle.begins;
    cycle.begins = std::move(begins);
  }
  return cycle;
}

}  // namespace fieldproof::valve_bus
