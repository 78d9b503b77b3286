#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "harness/kernel/time.hpp"
#include "protocols/valve_bus/rules.hpp"

// How long the PC's cycle takes: what it does goes out step by step, each as long as its frames and silences,
// and begins when the one before is over and its node is ready. A node whose valves are written is ready
// again when a write in the exchange before has reached them; a copy begins when what it copies has been
// read.
//
// Limit: a host that repeats writes meanwhile (refresh) is no part of it.
namespace fieldproof::valve_bus {

// What the PC does in a cycle, one after the other.
struct PollStep {
  std::size_t node = 0;  // index
  bool is_write = false;
  std::optional<std::size_t> copied_from{};  // of a write: whose limit switches

  friend bool operator==(const PollStep&, const PollStep&) = default;
};

struct PolledNode {
  kernel::Duration way{};   // from the host
  bool is_written = false;  // there is a step that writes it
};

struct PollCycle {
  // From the beginning of the first step to that of the next cycle, and the most that it ever is.
  kernel::Duration time{};
  kernel::Duration longest{};
  // Each cycle takes this time from some on.
  bool is_steady = false;
  std::vector<kernel::Duration> begins;  // of the steps, after the first of their cycle
};

PollCycle poll_cycle(const Rules& rules, const std::vector<PollStep>& steps,
                     const std::vector<PolledNode>& nodes);

// From the report of a response until a write in the same exchange must have reached the valves: it was sent
// before the read, so its time has begun a write distance earlier.
kernel::Duration rest_of_exchange(const Rules& rules);

}  // namespace fieldproof::valve_bus
