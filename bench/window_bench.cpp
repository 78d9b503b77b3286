// Control loops and saturated non-real-time queues under a server that visits node after node: the simulation
// of windows beside a loop that is written for this case alone. Both deliver the same; that is checked when a
// row is set up.
#include <array>
#include <cstdint>
#include <stdexcept>

#include "bench/rows.hpp"
#include "protocols/bandwidth/sample_plans.hpp"

namespace fieldproof::bench {
namespace {

constexpr std::uint64_t kSlots = 20'000;

bandwidth::WindowTraffic traffic_of_the_plan() {
  const bandwidth::Demand demand = bandwidth::fractional_density();
  return bandwidth::traffic_of(demand, allocate(demand).longest_safe / kernel::kMicrosecond);
}

struct Delivered {
  std::uint64_t data = 0;
  std::int64_t sum = 0;  // of delays, ps
  friend bool operator==(const Delivered&, const Delivered&) = default;
};

Delivered by_windows() {
  const auto figures = run_windows(
      traffic_of_the_plan(),
      {.slots = kSlots, .real_time = bandwidth::Load::none, .non_real_time = bandwidth::Load::saturated});
  Delivered all;
  for (const bandwidth::StreamFigures& stream : figures.streams) {
    all.data += stream.delivered;
    all.sum += stream.sum.count();
  }
  return all;
}

// As one would write it for this case alone: ten nodes, times as numbers, no packet of a real-time queue, and
// controllers that have their first datum after the slots that do not count.
Delivered by_hand() {
  constexpr int kNodes = 10;
  const bandwidth::WindowTraffic traffic = traffic_of_the_plan();
  const std::int64_t slot = traffic.slot.count();
  const std::int64_t overhead = traffic.overhead.count();
  const std::int64_t datum = traffic.periodic_packet.count();
  const std::int64_t other = traffic.non_real_time_packet.count();
  std::array<std::int64_t, kNodes> next{};
  std::array<std::int64_t, kNodes> period{};
  next.fill(INT64_MAX);
  std::array<int, kNodes> sensor_of{};
  sensor_of.fill(-1);
  std::array<bool, kNodes> has_newest{};
  for (const bandwidth::LoopTraffic& loop : traffic.loops) {
    next[loop.sensor] = loop.sensor_offset * slot;
    next[loop.controller] = loop.controller_offset * slot;
    period[loop.sensor] = period[loop.controller] = loop.every * slot;
    sensor_of[loop.sensor] = loop.controller;
    has_newest[loop.sensor] = true;
  }
  const std::int64_t from = static_cast<std::int64_t>(slots_of_start(traffic)) * slot;
  const std::int64_t until = from + static_cast<std::int64_t>(kSlots) * slot;
  Delivered all;
  int begun_by = -1;
  std::int64_t now = 0;
  for (std::size_t node = 0; now < until; node = node + 1 == kNodes ? 0 : node + 1) {
    if (begun_by == static_cast<int>(node)) begun_by = -1;
    // A controller without a datum lets its samplings pass.
    while (!has_newest[node] && next[node] <= now) next[node] += period[node];
    if (next[node] <= now) {
      if (begun_by < 0) begun_by = static_cast<int>(node);
      const std::int64_t generated = next[node];
      next[node] += period[node];
      now += datum;
      if (generated >= from) ++all.data, all.sum += now - generated;
      if (const int controller = sensor_of[node]; controller >= 0) {
        const auto at = static_cast<std::size_t>(controller);
        while (!has_newest[at] && next[at] < now) next[at] += period[at];
        has_newest[at] = true;
      }
    } else if (begun_by < 0) {
      now += other;
    }
    now += overhead;
  }
  return all;
}

Row row(const char* name, const char* against, double target, Delivered (*simulate)()) {
  return {"windows under a server", name, "slots", against, target, [simulate] {
            if (by_hand() != simulate()) {
              throw std::logic_error("the simulation of windows delivers something else than the loop");
            }
            return [simulate] {
              if (simulate().data == 0) throw std::logic_error("nothing was delivered");
              return kSlots;
            };
          }};
}

// At most three times the loop's time is asked for, as of the other models of traffic.
const Rows kWindows({row("a loop for this case alone", "", 0, &by_hand),
                     row("the simulation, against the loop", "a loop", 0.33, &by_windows)});

}  // namespace
}  // namespace fieldproof::bench
