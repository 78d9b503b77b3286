#include "protocols/bandwidth/stability.hpp"

#include <algorithm>

#include "harness/traffic/milliseconds.hpp"

namespace fieldproof::bandwidth {
namespace {

using kernel::Duration;
using traffic::ms;

double per_ms(const QueueTraffic& queue) {
  return queue.mean_gap > Duration::zero() ? 1 / ms(queue.mean_gap) : 0;
}

}  // namespace

Stability stability(const WindowTraffic& traffic, const Allocation& allocation) {
  Stability found;
  const double slot = ms(allocation.slot);
  const double overheads = ms(std::int64_t{traffic.nodes} * traffic.overhead);
  const double answer = ms(traffic.empty_answer);
  // Who is polled and sends a packet gives no empty answer.
  const double with_data = allocation.busy_slots() > 0 ? allocation.mean_load() / allocation.busy_slots() : 0;
  const double periodic_rotation = overheads + (traffic.nodes - with_data) * answer;
  const auto queues = static_cast<double>(traffic.non_real_time.size());
  const double other_rotation = overheads + (traffic.nodes - queues) * answer;

  found.periodic = allocation.mean_load() * ms(traffic.periodic_packet) / slot;
  for (const QueueTraffic& queue : traffic.real_time)
    found.real_time += per_ms(queue) * ms(traffic.real_time_packet);
  double most = 0;
  for (const QueueTraffic& queue : traffic.non_real_time) {
    found.non_real_time += per_ms(queue) * ms(traffic.non_real_time_packet);
    most = std::max(most, per_ms(queue));
  }
  const double of_periodic = allocation.busy_slots() * periodic_rotation / slot;
  found.server = of_periodic + most * other_rotation;
  const double rest = slot * (1 - found.periodic - found.real_time - of_periodic);
  found.saturated_packets =
      std::max(0.0, rest / (other_rotation + queues * ms(traffic.non_real_time_packet)));
  return found;
}

}  // namespace fieldproof::bandwidth
