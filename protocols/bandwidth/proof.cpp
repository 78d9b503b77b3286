#include "protocols/bandwidth/proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"

namespace fieldproof::bandwidth {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr std::uint64_t kMostVisits = 250'000'000;
constexpr std::uint64_t kFewestSlots = 100;
constexpr std::uint64_t kOtherRuns = 7;
// Simulated time is counted in picoseconds.
constexpr Duration kLongestRun = 20 * 86'400 * kernel::kSecond;

void expect_simulable(std::uint64_t visits_of_slot, std::uint64_t slots, std::uint64_t longest_run) {
  if (slots <= longest_run && slots <= 4 * kMostVisits / visits_of_slot) return;
  throw kernel::Error(
      kernel::ErrorKind::configuration,
      fmt::format(
          "a proof of this network takes {} slots or more with {} visits of the server each, which is "
          "too long to simulate; a shorter slot (the least bound), fewer nodes, loops whose bounds are "
          "nearer to each other or a larger overhead of the server take less",
          slots, visits_of_slot));
}

Duration slowest_of(const WindowTraffic& traffic) {
  Duration slowest{};
  for (std::uint64_t slot = 0; slot < traffic.repeats_after(); ++slot)
    slowest = std::max(slowest, slowest_datum(traffic, slot));
  return slowest;
}

// The data of this slot at the first nodes, one after the other, the other streams after them.
WindowTraffic in_a_row(WindowTraffic traffic, std::uint64_t slot) {
  constexpr int kNowhere = -1;
  std::vector<int> place(traffic.nodes, kNowhere);
  int next = 0;
  for (const std::uint8_t node : traffic.nodes_with_data(slot)) place[node] = next++;
  for (int& one : place) {
    if (one == kNowhere) one = next++;
  }
  const auto moved = [&](std::uint8_t node) { return static_cast<std::uint8_t>(place[node]); };
  for (LoopTraffic& loop : traffic.loops) {
    loop.sensor = moved(loop.sensor);
    loop.controller = moved(loop.controller);
  }
  for (QueueTraffic& queue : traffic.real_time) queue.node = moved(queue.node);
  traffic.non_real_time.clear();
  for (unsigned node = 0; node < traffic.nodes; ++node)
    traffic.non_real_time.push_back({.node = static_cast<std::uint8_t>(node)});
  return traffic;
}

class Prover {
 public:
  Prover(const WindowTraffic& traffic, std::uint64_t seed, std::uint64_t slots)
      : own_(traffic), worst_(worst_order(traffic)), random_(seed) {
    const Duration step = traffic.overhead + traffic.empty_answer;
    const auto visits = static_cast<std::uint64_t>(std::max<std::int64_t>(1, traffic.slot / step));
    const auto longest_run = static_cast<std::uint64_t>(kLongestRun / traffic.slot);
    slots_ = std::max(kFewestSlots, std::min({slots, kMostVisits / visits, longest_run}));
    const std::uint64_t runs = 2 * std::uint64_t{traffic.nodes} + kOtherRuns;
    expect_simulable(visits, slots_ + runs * slots_of_start(traffic), longest_run);
  }

  Proof prove() {
    for (const bool is_own : {true, false}) {
      against(is_own, Load::saturated, 4);
      against(is_own, Load::random, 5);
      against(is_own, Load::just_late, 6);
    }
    from_each_node(8);
    if (floods()) {
      proof_.has_growing_queues = true;
    } else if (has_arrivals()) {
      against(true, Load::arriving, 10);
      const WindowFigures& figures = proof_.runs.back().figures;
      proof_.has_growing_queues = figures.real_time.grows || figures.non_real_time.grows;
    }
    proof_.slowest_own = slowest_of(own_);
    proof_.slowest_of_all = slowest_of(worst_);
    join_loop_delays();
    return std::move(proof_);
  }

 private:
  // `part` of all slots: one of so many.
  void against(bool is_own, Load load, std::uint64_t part) {
    ProofRun run{.name = fmt::format("other queues send {}", name_of(load)),
                 .is_own_order = is_own,
                 .traffic = is_own ? own_ : worst_,
                 .run = {.seed = random_.split(name_of(load)).seed(),
                         .slots = slots_ / part,
                         .real_time = load,
                         .non_real_time = load},
                 .figures = {}};
    run.figures = run_windows(run.traffic, run.run);
    proof_.runs.push_back(std::move(run));
  }

  // The server is at each node in turn when the first slot begins, in a packet or not.
  void from_each_node(std::uint64_t part) {
    ProofRun all{.name = "always, from each node",
                 .is_own_order = true,
                 .traffic = own_,
                 .run = {.slots = std::max<std::uint64_t>(1, slots_ / part / own_.nodes / 2),
                         .real_time = Load::saturated,
                         .non_real_time = Load::saturated},
                 .figures = {}};
    WindowRun run = all.run;
    for (unsigned node = 0; node < own_.nodes; ++node) {
      for (const bool in_packet : {false, true}) {
        run.first_node = static_cast<std::uint8_t>(node);
        run.begins_in_packet = in_packet;
        const WindowFigures figures = run_windows(own_, run);
        if (all.figures.slots == 0) {
          all.figures = figures;
        } else {
          all.figures.add(figures);
        }
        if (!figures.first_late || is_late_) continue;
        is_late_ = true;
        all.run = run;
        all.figures.first_late = figures.first_late;
      }
    }
    proof_.runs.push_back(std::move(all));
  }

  void join_loop_delays() {
    proof_.longest_loop_delays.resize(own_.loops.size());
    for (const ProofRun& run : proof_.runs) {
      if (!run.is_own_order) continue;
      for (std::size_t n = 0; n < proof_.longest_loop_delays.size(); ++n) {
        Duration& longest = proof_.longest_loop_delays[n];
        longest = std::max(longest, run.figures.loops[n].longest_delay);
      }
    }
  }

  // One packet of a queue goes in a rotation at most, and one of the server alone takes this long.
  bool floods() const {
    const Duration rotation = own_.nodes * own_.overhead;
    const auto is_too_fast = [&](const QueueTraffic& queue) {
      return queue.mean_gap > Duration::zero() && queue.mean_gap < rotation;
    };
    return std::ranges::any_of(own_.real_time, is_too_fast) ||
           std::ranges::any_of(own_.non_real_time, is_too_fast);
  }

  bool has_arrivals() const {
    const auto arrives = [](const QueueTraffic& queue) { return queue.mean_gap > Duration::zero(); };
    return std::ranges::any_of(own_.real_time, arrives) || std::ranges::any_of(own_.non_real_time, arrives);
  }

  WindowTraffic own_;
  WindowTraffic worst_;
  kernel::Random random_;
  std::uint64_t slots_ = 0;
  bool is_late_ = false;
  Proof proof_;
};

struct Carried {
  std::uint64_t periodic = 0;
  std::uint64_t real_time = 0;
  std::vector<unsigned> non_real_time;  // nodes
  Duration begun_before{};              // rest of a packet that was on its way
  Duration packets{};
};

Carried carried_before(const ProofRun& run, const LateDatum& late) {
  Carried carried;
  WindowRun again = run.run;
  const auto until = static_cast<std::uint64_t>((late.delivered - kernel::kStart) / run.traffic.slot);
  const std::uint64_t start = slots_of_start(run.traffic);
  again.slots = until < start ? 1 : until - start + 1;
  again.on_sent = [&](const Sent& sent) {
    if (sent.end <= late.generated || sent.end >= late.delivered) return;
    const Duration within = sent.end - std::max(sent.begin, late.generated);
    carried.packets += within;
    if (sent.begin < late.generated) carried.begun_before = within;
    if (sent.packet == Packet::periodic) ++carried.periodic;
    if (sent.packet == Packet::real_time) ++carried.real_time;
    if (sent.packet == Packet::non_real_time) carried.non_real_time.push_back(sent.node);
  };
  run_windows(run.traffic, again);
  return carried;
}

}  // namespace

std::uint64_t Proof::slots() const {
  std::uint64_t sum = 0;
  for (const ProofRun& run : runs) sum += run.figures.slots;
  return sum;
}

Duration Proof::longest_of_start() const {
  Duration longest{};
  for (const ProofRun& run : runs) {
    if (run.is_own_order) longest = std::max(longest, run.figures.longest_of_start);
  }
  return longest;
}

bool Proof::holds() const {
  return std::ranges::all_of(runs, [](const ProofRun& run) { return !run.is_own_order || run.holds(); });
}

bool Proof::holds_in_any_order() const {
  return std::ranges::all_of(runs, &ProofRun::holds);
}

Duration Proof::longest() const {
  Duration longest{};
  for (const ProofRun& run : runs) longest = std::max(longest, run.figures.longest());
  return longest;
}

WindowTraffic worst_order(const WindowTraffic& traffic) {
  WindowTraffic worst = traffic;
  Duration slowest{-1};
  std::set<std::size_t> seen;  // with as many data a slot in a row is the same
  for (std::uint64_t slot = 0; slot < traffic.repeats_after(); ++slot) {
    const std::size_t data = traffic.nodes_with_data(slot).size();
    if (data == 0 || !seen.insert(data).second) continue;
    WindowTraffic ordered = in_a_row(traffic, slot);
    const Duration delay = slowest_datum(ordered, slot);
    if (delay <= slowest) continue;
    slowest = delay;
    worst = std::move(ordered);
  }
  return worst;
}

Proof prove(const WindowTraffic& traffic, std::uint64_t seed, std::uint64_t slots) {
  check(traffic);
  return Prover(traffic, seed, slots).prove();
}

std::string story_of_late(const ProofRun& run) {
  const LateDatum& late = *run.figures.first_late;
  const LoopTraffic& loop = run.traffic.loops[late.stream / 2];
  const bool is_controller = late.stream % 2 == 1;
  const Carried carried = carried_before(run, late);
  const Duration delay = late.delivered - late.generated;
  const auto slot = static_cast<std::uint64_t>((late.generated - kernel::kStart) / run.traffic.slot);
  return fmt::format(
      "the datum that the {} of loop {} (node {}) generates at {} is sent {} later, {} over T_1. Before it "
      "go {} "
      "non-real-time packets{}, {} real-time packets and {} of the {} data of its slot; the server takes the "
      "rest",
      is_controller ? "controller" : "sensor", late.stream / 2 + 1,
      is_controller ? loop.controller : loop.sensor, kernel::describe(late.generated),
      kernel::describe(delay), kernel::describe(delay - run.traffic.slot), carried.non_real_time.size(),
      carried.begun_before > Duration::zero()
          ? fmt::format(" (the first has begun before, {} of it are left)",
                        kernel::describe(carried.begun_before))
          : "",
      carried.real_time, carried.periodic, run.traffic.nodes_with_data(slot).size());
}

}  // namespace fieldproof::bandwidth
