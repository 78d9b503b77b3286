#pragma once

#ifdef FIELDPROOF_HAVE_NS3

#include <ns3/nstime.h>
#include <ns3/object-factory.h>
#include <ns3/simulator.h>

#include <cstdint>
#include <deque>
#include <optional>

#include "harness/kernel/random.hpp"
#include "harness/traffic/poisson_arrivals.hpp"

// What simulations on ns-3 have in common here: its simulator with one of its queues, a step of time that is
// a picosecond, and packets that arrive as events, as users of ns-3 write it, or are drawn when somebody
// looks.
namespace fieldproof::bench {

enum class Ns3Arrivals { events, drawn_at_visits };

inline kernel::Time ns3_now() {
  return kernel::kStart + kernel::Duration{ns3::Simulator::Now().GetTimeStep()};
}
inline ns3::Time ns3_step(kernel::Duration duration) {
  return ns3::TimeStep(static_cast<std::uint64_t>(duration.count()));
}

// The simulator with this queue, as long as it lives. One at a time.
class Ns3Simulation {
 public:
  explicit Ns3Simulation(const char* queue) {
    ns3::ObjectFactory factory;
    factory.SetTypeId(queue);
    ns3::Simulator::SetScheduler(factory);
  }
  ~Ns3Simulation() { ns3::Simulator::Destroy(); }
  Ns3Simulation(const Ns3Simulation&) = delete;
  Ns3Simulation& operator=(const Ns3Simulation&) = delete;
};

class Ns3Queue {
 public:
  Ns3Queue(double per_ms, const kernel::Random& random, Ns3Arrivals arrivals)
      : arrivals_(per_ms, random), has_events_(arrivals == Ns3Arrivals::events) {}

  // From now on, where arrivals are events; the queue must stay where it is.
  void begin() {
    if (has_events_) expect();
  }
  // When the packet came that goes now; nothing where there is none.
  std::optional<kernel::Time> take() {
    for (; !has_events_ && arrivals_.next() <= ns3_now(); arrivals_.draw())
      waiting_.push_back(arrivals_.next());
    if (waiting_.empty()) return std::nullopt;
    const kernel::Time first = waiting_.front();
    waiting_.pop_front();
    return first;
  }

 private:
  void expect() {
    ns3::Simulator::Schedule(ns3_step(arrivals_.next() - ns3_now()), &Ns3Queue::on_arrival, this);
  }
  void on_arrival() {
    waiting_.push_back(arrivals_.next());
    arrivals_.draw();
    expect();
  }

  traffic::PoissonArrivals arrivals_;
  bool has_events_;
  std::deque<kernel::Time> waiting_;
};

inline constexpr char kMapQueue[] = "ns3::MapScheduler";
inline constexpr char kHeapQueue[] = "ns3::HeapScheduler";
inline constexpr char kPriorityQueue[] = "ns3::PriorityQueueScheduler";
inline constexpr char kCalendarQueue[] = "ns3::CalendarScheduler";

}  // namespace fieldproof::bench

#endif
