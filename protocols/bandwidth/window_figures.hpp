#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/kernel/time.hpp"

// What a simulation of windows counts.
namespace fieldproof::bandwidth {

// 2n is the sensor of loop n, 2n + 1 its controller.
struct StreamFigures {
  std::uint64_t generated = 0;
  std::uint64_t delivered = 0;
  std::uint64_t replaced = 0;   // by the next one, before they were sent
  std::uint64_t over_slot = 0;  // that took longer than T_1
  kernel::Duration longest{};
  kernel::Duration sum{};
};

struct LoopFigures {
  std::uint64_t samplings = 0;  // of the controller
  std::uint64_t vacant = 0;
  std::uint64_t lost = 0;            // arrived and not used
  kernel::Duration longest_delay{};  // from a sample to the actuator that it moves
};

struct LateDatum {
  std::size_t stream = 0;
  kernel::Time generated{};
  kernel::Time delivered{};
};

struct QueueFigures {
  std::uint64_t sent = 0;
  std::uint64_t waiting = 0;   // at the end
  kernel::Duration longest{};  // from when a packet that arrived is the first of its queue until it is sent
  bool grows = false;          // beyond what chance makes of a queue that is stable
};

struct WindowFigures {
  std::vector<StreamFigures> streams;
  std::vector<LoopFigures> loops;
  QueueFigures real_time, non_real_time;  // all queues of the kind
  std::uint64_t slots = 0;
  std::uint64_t visits = 0;
  kernel::Duration longest_of_start{};    // delay of a datum of slots that are not counted yet
  std::optional<LateDatum> first_late{};  // over T_1

  // Of another run of the same traffic; the first late datum stays that of this one.
  void add(const WindowFigures& one);
  kernel::Duration longest() const;
  std::uint64_t over_slot() const;
  std::uint64_t lost() const;  // replaced, or arrived and not used
  std::uint64_t vacant() const;
  std::uint64_t samplings() const;
};

}  // namespace fieldproof::bandwidth
