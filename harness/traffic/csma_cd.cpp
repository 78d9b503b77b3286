#include "harness/traffic/csma_cd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <vector>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
#include "harness/traffic/milliseconds.hpp"
#include "harness/traffic/poisson_arrivals.hpp"

namespace fieldproof::traffic {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr unsigned kLongestExponent = 10;
constexpr std::size_t kMostWaitingFrames = 100'000;

struct CsmaStation {
  PoissonArrivals arrivals;
  kernel::Random backoff;
  std::deque<Time> waiting{};   // by arrival
  Time ready = kernel::kStart;  // when the first of them may begin, but for the carrier
  unsigned attempts = 0;        // of the first one, that collided
};

class Ether {
 public:
  Ether(const CsmaCd& line, const CsmaRun& run) : line_(line), run_(run) {
    const kernel::Random random(run.seed);
    for (unsigned n = 0; n < line.stations; ++n) {
      stations_.push_back({PoissonArrivals(line.per_ms, random.split("arrivals").split(n)),
                           random.split("backoff").split(n)});
    }
  }

  CsmaFigures go_on() {
    while (figures_.sent + figures_.given_up < run_.frames && figures_.longest_queue < kMostWaitingFrames)
      step();
    const double time = ms(idle_from_ - kernel::kStart);
    figures_.carried = static_cast<double>(figures_.sent) * ms(line_.frame) / time;
    return std::move(figures_);
  }

 private:
  // When this station would begin, if nobody else does.
  Time begin_of(const CsmaStation& station) const {
    const Time ready = station.waiting.empty() ? station.arrivals.next() : station.ready;
    return std::max(ready, idle_from_);
  }

  void step() {
    Time first = kernel::kNever;
    for (const CsmaStation& station : stations_) first = std::min(first, begin_of(station));
    beginning_.clear();
    Time last = first;
    for (CsmaStation& station : stations_) {
      const Time begin = begin_of(station);
      // The signal of the first has not yet come to those that begin before this.
      if (begin > first && begin >= first + line_.propagation) continue;
      last = std::max(last, begin);
      beginning_.push_back(&station);
    }
    take_arrivals(last);
    if (beginning_.size() == 1) {
      send(*beginning_.front(), first);
    } else {
      collide(last);
    }
  }

  // Whatever has arrived by then waits; only a frame that was first in an empty queue has an instant of its
  // own.
  void take_arrivals(Time until) {
    for (CsmaStation& station : stations_) take_arrivals(station, until);
  }
  void take_arrivals(CsmaStation& station, Time until) {
    for (; station.arrivals.next() <= until; station.arrivals.draw()) {
      if (station.waiting.empty()) station.ready = station.arrivals.next();
      station.waiting.push_back(station.arrivals.next());
    }
    figures_.longest_queue = std::max<std::uint64_t>(figures_.longest_queue, station.waiting.size());
  }

  void send(CsmaStation& station, Time begin) {
    const Time end = begin + line_.frame;
    const Duration delay = end - station.waiting.front();
    figures_.delays.add(delay);
    if (delay > run_.bound) ++figures_.beyond;
    ++figures_.sent;
    next_frame(station, end);
    idle_from_ = end + line_.propagation + line_.gap;
  }

  void collide(Time last) {
    ++figures_.collisions;
    const auto is_new = [](const CsmaStation* station) { return station->attempts == 0; };
    if (std::ranges::all_of(beginning_, is_new)) ++figures_.first_collisions;
    const Time end = last + line_.propagation + line_.jam;
    idle_from_ = end + line_.gap;
    for (CsmaStation* station : beginning_) {
      if (++station->attempts == kMostAttempts) {
        ++figures_.given_up;
        next_frame(*station, end);
        continue;
      }
      const unsigned exponent = std::min(station->attempts, kLongestExponent);
      const auto slots = static_cast<std::int64_t>(station->backoff.below(std::uint64_t{1} << exponent));
      station->ready = end + slots * line_.slot;
    }
  }

  void next_frame(CsmaStation& station, Time now) {
    station.waiting.pop_front();
    station.attempts = 0;
    take_arrivals(station, now);
    if (!station.waiting.empty()) station.ready = std::max(now, station.waiting.front());
  }

  const CsmaCd line_;
  const CsmaRun run_;
  std::vector<CsmaStation> stations_;
  std::vector<CsmaStation*> beginning_;
  CsmaFigures figures_;
  Time idle_from_ = kernel::kStart;  // the gap included
};

void check_csma(const CsmaCd& line, const CsmaRun& run) {
  const auto refuse = [](const std::string& sentence) {
    throw kernel::Error(kernel::ErrorKind::configuration, sentence);
  };
  if (line.stations < 1 || line.stations > kMostCsmaStations) {
    refuse(fmt::format("{} stations on an Ethernet cannot be simulated; 1 to {} can", line.stations,
                       kMostCsmaStations));
  }
  if (line.frame < line.slot) refuse("a frame lasts at least a slot: collisions would not be detected");
  if (line.slot <= Duration::zero() || line.propagation < Duration::zero() ||
      2 * line.propagation > line.slot || line.jam < Duration::zero() || line.gap < Duration::zero()) {
    refuse("a slot is at least twice the propagation time, and no time is negative");
  }
  if (!(line.per_ms > 0 && line.per_ms <= 1e3) || run.frames == 0) {
    refuse("some frames arrive, at most 1000 in a millisecond, and some are counted");
  }
}

}  // namespace

CsmaFigures run_csma_cd(const CsmaCd& line, const CsmaRun& run) {
  check_csma(line, run);
  return Ether(line, run).go_on();
}

}  // namespace fieldproof::traffic
