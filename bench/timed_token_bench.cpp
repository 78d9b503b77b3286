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

#include "bench/ns3_queue.hpp"
#include "bench/rows.hpp"
#include "harness/kernel/random.hpp"
#include "harness/measure/distribution.hpp"
#include "harness/traffic/poisson_arrivals.hpp"
#include "harness/traffic/timed_token.hpp"
#include "harness/traffic/token_loads.hpp"

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
// Each visit of the token, each end of a frame and each arrival is an event of ns-3's simulator.
class TimedOnNs3 {
 public:
  explicit TimedOnNs3(const char* queue) : simulation_(queue) {
    const kernel::Random random(kSeed);
    for (std::size_t place = 0; place < traffic::kAccessClasses; ++place) {
      if (kFrames.per_ms[place] == 0) continue;
      const kernel::Random of_class = random.split(traffic::name_of(static_cast<AccessClass>(place)));
      for (unsigned n = 0; n < kTokenStations; ++n) {
        queues_[place].emplace_back(kFrames.per_ms[place], of_class.split(n), Ns3Arrivals::events);
        queues_[place].back().begin();
      }
    }
  }

  TokenFigures run() {
    ns3::Simulator::Schedule(ns3::TimeStep(0), &TimedOnNs3::on_token, this);
    ns3::Simulator::Run();
    return {digits_of(delays_), digits_of(rotations_)};
  }

 private:
  void on_token() {
    if (visits_++ == kVisits) {
      ns3::Simulator::Stop();
      return;
    }
    if (const auto arrived = std::exchange(arrived_[station_], ns3_now()))
      rotations_.add(ns3_now() - *arrived);
    place_ = 0;
    end_ = ns3_now() + kTimed.hold;
    serve();
  }

  void serve() {
    for (;;) {
      if (ns3_now() < end_ && !queues_[place_].empty()) {
        if (const auto arrived = queues_[place_][station_].take()) {
          if (place_ == 0) delays_.add(ns3_now() + kFrames.frame - *arrived);
          ns3::Simulator::Schedule(ns3_step(kFrames.frame), &TimedOnNs3::serve, this);
          return;
        }
      }
      do {
        ++place_;
      } while (place_ < traffic::kAccessClasses && kTimed.targets[place_ - 1] == Duration::zero());
      if (place_ == traffic::kAccessClasses) break;
      auto& run_out = run_out_[station_][place_ - 1];
      end_ = run_out ? *run_out : ns3_now();
      run_out = ns3_now() + kTimed.targets[place_ - 1];
    }
    station_ = (station_ + 1) % kTokenStations;
    ns3::Simulator::Schedule(ns3_step(kTimed.pass), &TimedOnNs3::on_token, this);
  }

  Ns3Simulation simulation_;
  std::array<std::deque<Ns3Queue>, traffic::kAccessClasses> queues_;
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
  rows.push_back(timed_row("ns-3, map (its default)", "", 0, &timed_by_ns3<kMapQueue>));
  rows.push_back(timed_row("ns-3, heap", "", 0, &timed_by_ns3<kHeapQueue>));
  rows.push_back(timed_row("ns-3, priority queue", "", 0, &timed_by_ns3<kPriorityQueue>));
  rows.push_back(timed_row("ns-3, calendar", "", 0, &timed_by_ns3<kCalendarQueue>));
#endif
  rows.push_back(timed_row("the traffic model", "ns-3", 5, &by_model));
  return rows;
}

const Rows kTimedToken(rows_of_timed_token());

}  // namespace
}  // namespace fieldproof::bench
