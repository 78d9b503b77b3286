// Frames of class 6 and class 0 under the token of IEEE 802.4: the traffic model beside ns-3's simulator with
// each of its queues. All draw the same arrivals, so delays and rotations are the same to the digit; that is
// checked when a row is set up.
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bench/rows.hpp"
#include "harness/kernel/random.hpp"
#include "harness/measure/distribution.hpp"
#include "harness/traffic/poisson_arrivals.hpp"
#include "harness/traffic/timed_token.hpp"
#include "harness/traffic/token_loads.hpp"

#ifdef FIELDPROOF_HAVE_NS3
#include <ns3/nstime.h>
#include <ns3/object-factory.h>
#include <ns3/simulator.h>
#endif

namespace fieldproof::bench {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using traffic::AccessClass;

constexpr std::uint64_t kVisits = 200'000;
constexpr unsigned kTokenStations = 16;
const traffic::TimedToken kTimed{.stations = kTokenStations,
                                 .pass = 40 * kMicrosecond,
                                 .hold = 300 * kMicrosecond,
                                 .targets = {{{}, {}, 5'000 * kMicrosecond}},
                                 .longest_frame = 130 * kMicrosecond};
const traffic::QueuedFrames::Settings kFrames{
    .frame = kTimed.longest_frame, .per_ms = {{0.15, 0, 0, 0.15}}, .bound = {}};
constexpr std::uint64_t kSeed = 1;

struct Digits {
  std::uint64_t count = 0;
  double mean = 0;  // ps
  std::int64_t longest = 0;
  friend bool operator==(const Digits&, const Digits&) = default;
};
struct TokenFigures {
  Digits delays;  // of class 6
  Digits rotations;
  friend bool operator==(const TokenFigures&, const TokenFigures&) = default;
};

Digits digits_of(const measure::Distribution& one) {
  return {one.count(), one.mean(), one.max()};
}

TokenFigures by_model() {
  traffic::QueuedFrames frames(kTimed, kFrames, kernel::Random(kSeed));
  const traffic::TimedTokenFigures figures = traffic::rotate_timed_token(kTimed, frames, kVisits);
  return {digits_of(frames.delays(AccessClass::six)), digits_of(figures.rotations)};
}

#ifdef FIELDPROOF_HAVE_NS3
// Each visit of the token, each end of a frame and each arrival is an event of ns-3's simulator. A step of
// its time is a picosecond here.
class TimedOnNs3 {
 public:
  explicit TimedOnNs3(const char* queue) {
    ns3::ObjectFactory factory;
    factory.SetTypeId(queue);
    ns3::Simulator::SetScheduler(factory);
    const kernel::Random random(kSeed);
    for (std::size_t place = 0; place < traffic::kAccessClasses; ++place) {
      if (kFrames.per_ms[place] == 0) continue;
      const kernel::Random of_class = random.split(traffic::name_of(static_cast<AccessClass>(place)));
      for (unsigned n = 0; n < kTokenStations; ++n) {
        queues_[place].emplace_back(kFrames.per_ms[place], of_class.split(n));
        queues_[place].back().expect();
      }
    }
  }
  ~TimedOnNs3() { ns3::Simulator::Destroy(); }
  TimedOnNs3(const TimedOnNs3&) = delete;
  TimedOnNs3& operator=(const TimedOnNs3&) = delete;

  TokenFigures run() {
    ns3::Simulator::Schedule(ns3::TimeStep(0), &TimedOnNs3::on_token, this);
    ns3::Simulator::Run();
    return {digits_of(delays_), digits_of(rotations_)};
  }

 private:
  static kernel::Time now() { return kernel::kStart + Duration{ns3::Simulator::Now().GetTimeStep()}; }
  static ns3::Time step(Duration duration) {
    return ns3::TimeStep(static_cast<std::uint64_t>(duration.count()));
  }

  class Queue {
   public:
    Queue(double per_ms, const kernel::Random& random) : arrivals_(per_ms, random) {}
    // Those of this instant have come.
    void expect() { ns3::Simulator::Schedule(step(arrivals_.next() - now()), &Queue::on_arrival, this); }
    std::optional<kernel::Time> take() {
      if (waiting_.empty()) return std::nullopt;
      const kernel::Time first = waiting_.front();
      waiting_.pop_front();
      return first;
    }

   private:
    void on_arrival() {
      waiting_.push_back(arrivals_.next());
      arrivals_.draw();
      expect();
    }

    traffic::PoissonArrivals arrivals_;
    std::deque<kernel::Time> waiting_;
  };

  void on_token() {
    if (visits_++ == kVisits) {
      ns3::Simulator::Stop();
      return;
    }
    if (const auto arrived = std::exchange(arrived_[station_], now())) rotations_.add(now() - *arrived);
    place_ = 0;
    end_ = now() + kTimed.hold;
    serve();
  }

  void serve() {
    for (;;) {
      if (now() < end_ && !queues_[place_].empty()) {
        if (const auto arrived = queues_[place_][station_].take()) {
          if (place_ == 0) delays_.add(now() + kFrames.frame - *arrived);
          ns3::Simulator::Schedule(step(kFrames.frame), &TimedOnNs3::serve, this);
          return;
        }
      }
      do {
        ++place_;
      } while (place_ < traffic::kAccessClasses && kTimed.targets[place_ - 1] == Duration::zero());
      if (place_ == traffic::kAccessClasses) break;
      auto& run_out = run_out_[station_][place_ - 1];
      end_ = run_out ? *run_out : now();
      run_out = now() + kTimed.targets[place_ - 1];
    }
    station_ = (station_ + 1) % kTokenStations;
    ns3::Simulator::Schedule(step(kTimed.pass), &TimedOnNs3::on_token, this);
  }

  std::array<std::deque<Queue>, traffic::kAccessClasses> queues_;
  std::array<std::array<std::optional<kernel::Time>, 3>, kTokenStations> run_out_{};
  std::array<std::optional<kernel::Time>, kTokenStations> arrived_{};
  measure::Distribution delays_;
  measure::Distribution rotations_;
  std::uint64_t visits_ = 0;
  unsigned station_ = 0;
  std::size_t place_ = 0;
  kernel::Time end_ = kernel::kStart;
};

template <const char* queue>
TokenFigures timed_by_ns3() {
  return TimedOnNs3(queue).run();
}

constexpr char kMap[] = "ns3::MapScheduler";
constexpr char kHeap[] = "ns3::HeapScheduler";
constexpr char kPriority[] = "ns3::PriorityQueueScheduler";
constexpr char kCalendar[] = "ns3::CalendarScheduler";
#endif

Row timed_row(const char* name, const char* against, double target, TokenFigures (*simulate)()) {
  return {"frames under the token of IEEE 802.4", name, "visits", against, target, [simulate] {
            if (!(by_model() == simulate()))
              throw std::logic_error("a simulation of the timed token has other figures than the model");
            return [simulate] {
              if (simulate().delays.count == 0) throw std::logic_error("nobody has waited");
              return kVisits;
            };
          }};
}

std::vector<Row> rows_of_timed_token() {
  std::vector<Row> rows;
#ifdef FIELDPROOF_HAVE_NS3
  rows.push_back(timed_row("ns-3, map (its default)", "", 0, &timed_by_ns3<kMap>));
  rows.push_back(timed_row("ns-3, heap", "", 0, &timed_by_ns3<kHeap>));
  rows.push_back(timed_row("ns-3, priority queue", "", 0, &timed_by_ns3<kPriority>));
  rows.push_back(timed_row("ns-3, calendar", "", 0, &timed_by_ns3<kCalendar>));
#endif
  rows.push_back(timed_row("the traffic model", "ns-3", 5, &by_model));
  return rows;
}

const Rows kTimedToken(rows_of_timed_token());

}  // namespace
}  // namespace fieldproof::bench
