// Urgent packets under the token of a Foundation Fieldbus: the simulation on the scheduler beside a loop
// without any event queue. Both draw the same arrivals, so their delays are the same to the digit; that is
// checked when a row is set up.
#include <cstdint>
#include <deque>
#include <stdexcept>
#include <vector>

#include "bench/rows.hpp"
#include "harness/kernel/random.hpp"
#include "protocols/fieldbus_dll/token_rotation.hpp"

namespace fieldproof::bench {
namespace {

using fieldbus_dll::TokenRun;
using fieldbus_dll::UrgentTraffic;

constexpr TokenRun kRun{.seed = 1, .urgent_packets = 50'000, .warm_up_rotations = 100};

UrgentTraffic traffic_of_the_paper() {
  return fieldbus_dll::paper_traffic(0.35, 1, 1, 34'816 * kernel::kMicrosecond);
}

// As one would write it for this case alone: 16 nodes, times as numbers.
class HandWritten {
 public:
  explicit HandWritten(const UrgentTraffic& traffic)
      : urgent_length_(traffic.urgent_length.count()),
        available_length_(traffic.available_length.count()),
        overhead_(traffic.empty_rotation.count() / std::int64_t{kNodes}),
        target_(traffic.target_rotation.count()) {
    const kernel::Random random(kRun.seed);
    for (std::uint64_t n = 0; n < kNodes; ++n) {
      urgent_.push_back({1e9 / traffic.urgent_per_ms, random.split("urgent").split(n), 0, {}});
      available_.push_back({1e9 / traffic.available_per_ms, random.split("time-available").split(n), 0, {}});
      urgent_.back().draw();
      available_.back().draw();
    }
  }

  double mean_delay() {
    std::int64_t now = 0;
    std::int64_t start = 0;
    bool all = true;
    double sum = 0;
    std::uint64_t count = 0;
    for (std::uint64_t rotation = 0; count < kRun.urgent_packets; ++rotation) {
      const bool counts = rotation >= kRun.warm_up_rotations;
      for (std::size_t n = 0; n < kNodes && count < kRun.urgent_packets; ++n) {
        now += overhead_;
        if (const std::int64_t arrived = urgent_[n].take(now); arrived >= 0) {
          now += urgent_length_;
          if (counts) sum += static_cast<double>(now - arrived) / 1e9, ++count;
        }
        if (all && available_[n].take(now) >= 0) now += available_length_;
      }
      all = now - start < target_;
      start = now;
    }
    return sum / static_cast<double>(count);
  }

 private:
  static constexpr std::size_t kNodes = 16;

  struct Queue {
    double mean_gap;
    kernel::Random random;
    std::int64_t next;
    std::deque<std::int64_t> waiting;

    void draw() { next += static_cast<std::int64_t>(-mean_gap * kernel::portable_log(1 - random.uniform())); }
    // When the packet came that goes now; -1: none is there.
    std::int64_t take(std::int64_t now) {
      for (; next <= now; draw()) waiting.push_back(next);
      if (waiting.empty()) return -1;
      const std::int64_t first = waiting.front();
      waiting.pop_front();
      return first;
    }
  };

  std::int64_t urgent_length_, available_length_, overhead_, target_;
  std::vector<Queue> urgent_, available_;
};

double by_hand() {
  return HandWritten(traffic_of_the_paper()).mean_delay();
}

double by_scheduler() {
  return fieldbus_dll::rotate_token(traffic_of_the_paper(), kRun).mean_delay;
}

Row row(const char* name, const char* against, double target, double (*simulate)()) {
  return {"urgent packets under a token", name, "packets", against, target, [simulate] {
            if (by_hand() != by_scheduler()) {
              throw std::logic_error("the token on the scheduler has other delays than the loop");
            }
            return [simulate] {
              if (!(simulate() > 0)) throw std::logic_error("nobody has waited");
              return kRun.urgent_packets;
            };
          }};
}

// At most three times the loop's time is asked for.
const Rows kToken({row("a loop without events", "", 0, &by_hand),
                   row("on the scheduler", "a loop", 0.33, &by_scheduler)});

}  // namespace
}  // namespace fieldproof::bench
