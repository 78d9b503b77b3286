// Urgent packets under the token of a Foundation Fieldbus: the simulation on the scheduler beside a loop
// without any event queue, and beside ns-3's simulator with each of its queues. All draw the same arrivals,
// so their delays are the same to the digit; that is checked when a row is set up.
#include <cstdint>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/ns3_queue.hpp"
#include "bench/rows.hpp"
#include "harness/kernel/random.hpp"
#include "harness/traffic/milliseconds.hpp"
#include "harness/traffic/poisson_arrivals.hpp"
#include "harness/traffic/token_rotation.hpp"

namespace fieldproof::bench {
namespace {

using traffic::TokenRun;
using traffic::UrgentTraffic;

constexpr TokenRun kRun{.seed = 1, .urgent_packets = 50'000, .warm_up_rotations = 100};

UrgentTraffic traffic_of_the_paper() {
  return traffic::paper_traffic(0.35, 1, 1, 34'816 * kernel::kMicrosecond);
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
  return traffic::rotate_token(traffic_of_the_paper(), kRun).mean_delay;
}

#ifdef FIELDPROOF_HAVE_NS3
// Each visit of the token and each end of an urgent transmission is an event of ns-3's simulator.
class OnNs3 {
 public:
  OnNs3(const UrgentTraffic& traffic, const char* queue, Ns3Arrivals arrivals)
      : simulation_(queue), traffic_(traffic) {
    const kernel::Random random(kRun.seed);
    for (std::uint64_t n = 0; n < kNs3Nodes; ++n) {
      urgent_.emplace_back(traffic.urgent_per_ms, random.split("urgent").split(n), arrivals);
      available_.emplace_back(traffic.available_per_ms, random.split("time-available").split(n), arrivals);
    }
  }

  double mean_delay() {
    for (Ns3Queue& queue : urgent_) queue.begin();
    for (Ns3Queue& queue : available_) queue.begin();
    schedule(overhead_, &OnNs3::on_token);
    ns3::Simulator::Run();
    return sum_ / static_cast<double>(count_);
  }

 private:
  static constexpr std::size_t kNs3Nodes = 16;

  void schedule(kernel::Duration after, void (OnNs3::*what)()) {
    ns3::Simulator::Schedule(ns3_step(after), what, this);
  }

  void on_token() {
    const auto arrived = urgent_[at_].take();
    if (!arrived) {
      on_urgent_sent();
      return;
    }
    if (rotation_ >= kRun.warm_up_rotations) {
      sum_ += traffic::ms(ns3_now() + traffic_.urgent_length - *arrived);
      if (++count_ == kRun.urgent_packets) ns3::Simulator::Stop();
    }
    schedule(traffic_.urgent_length, &OnNs3::on_urgent_sent);
  }

  void on_urgent_sent() {
    leave(admits_all_ && available_[at_].take() ? traffic_.available_length : kernel::Duration{});
  }

  // The next visit, when this transmission is over.
  void leave(kernel::Duration transmission) {
    if (++at_ == kNs3Nodes) {
      at_ = 0;
      ++rotation_;
      const kernel::Time end = ns3_now() + transmission;
      admits_all_ = end - start_ < traffic_.target_rotation;
      start_ = end;
    }
    schedule(transmission + overhead_, &OnNs3::on_token);
  }

  Ns3Simulation simulation_;
  UrgentTraffic traffic_;
  kernel::Duration overhead_ = traffic_.empty_rotation / std::int64_t{kNs3Nodes};
  std::vector<Ns3Queue> urgent_, available_;
  std::size_t at_ = 0;
  std::uint64_t rotation_ = 0;
  bool admits_all_ = true;
  kernel::Time start_ = kernel::kStart;
  double sum_ = 0;
  std::uint64_t count_ = 0;
};

template <const char* queue, Ns3Arrivals arrivals = Ns3Arrivals::events>
double by_ns3() {
  return OnNs3(traffic_of_the_paper(), queue, arrivals).mean_delay();
}
#endif

Row row(const char* name, const char* against, double target, double (*simulate)()) {
  return {"urgent packets under a token", name, "packets", against, target, [simulate] {
            if (by_hand() != simulate()) {
              throw std::logic_error("a simulation of the token has other delays than the loop");
            }
            return [simulate] {
              if (!(simulate() > 0)) throw std::logic_error("nobody has waited");
              return kRun.urgent_packets;
            };
          }};
}

std::vector<Row> rows_of_token() {
  std::vector<Row> rows;
#ifdef FIELDPROOF_HAVE_NS3
  rows.push_back(row("ns-3, map (its default)", "", 0, &by_ns3<kMapQueue>));
  rows.push_back(row("ns-3, heap", "", 0, &by_ns3<kHeapQueue>));
  rows.push_back(row("ns-3, priority queue", "", 0, &by_ns3<kPriorityQueue>));
  rows.push_back(row("ns-3, calendar", "", 0, &by_ns3<kCalendarQueue>));
  rows.push_back(row("arrivals drawn at visits, on ns-3, priority queue", "", 0,
                     &by_ns3<kPriorityQueue, Ns3Arrivals::drawn_at_visits>));
#endif
  rows.push_back(row("a loop without events", "", 0, &by_hand));
  // At most three times the loop's time, and at most a fifth of ns-3's, are asked for.
  rows.push_back(row("on the scheduler, against the loop", "a loop", 0.33, &by_scheduler));
  rows.push_back(row("on the scheduler, against ns-3", "ns-3", 5, &by_scheduler));
  return rows;
}

const Rows kToken(rows_of_token());

}  // namespace
}  // namespace fieldproof::bench
