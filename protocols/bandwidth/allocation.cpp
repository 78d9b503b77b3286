#include "protocols/bandwidth/allocation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "harness/kernel/error.hpp"

namespace fieldproof::bandwidth {
namespace {

using kernel::Duration;

constexpr Duration kLongestBound = 1'000 * kernel::kSecond;
constexpr Duration kLongestPacket = kernel::kSecond;

[[noreturn]] void refuse_demand(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::configuration, sentence);
}

// Towards minus infinity, so that a lack of room stays one.
Duration whole_microseconds(Duration duration) {
  const Duration floor = duration / kernel::kMicrosecond * kernel::kMicrosecond;
  return floor > duration ? floor - kernel::kMicrosecond : floor;
}

void check_demand(const Demand& demand) {
  if (demand.bounds.empty() || demand.bounds.size() > kMostLoops) {
    refuse_demand(fmt::format("1 to {} control loops share a line", kMostLoops));
  }
  if (demand.nodes > kMostNodes || demand.nodes < 2 * demand.bounds.size()) {
    refuse_demand(
        fmt::format("{} loops have {} nodes with data; the server visits {} nodes, and up to {} have an "
                    "address in the periodic byte",
                    demand.bounds.size(), 2 * demand.bounds.size(), demand.nodes, kMostNodes));
  }
  for (const Duration bound : demand.bounds) {
    if (bound < 3 * kernel::kMicrosecond || bound > kLongestBound) {
      refuse_demand(fmt::format("a loop delay of at most {} cannot be planned; 3 us to 1000 s can",
                                kernel::describe(bound)));
    }
  }
  for (const Duration time : {demand.overhead, demand.periodic_packet, demand.real_time_packet}) {
    if (time < Duration::zero() || time > kLongestPacket)
      refuse_demand("a packet and the server take 0 to 1 s");
  }
}

// k: the largest power of two with which the loop keeps its bound.
unsigned slots_between(Rule rule, Duration bound, Duration slot) {
  const std::int64_t most = rule == Rule::hong ? (bound - slot) / (2 * slot) : (bound - 2 * slot) / slot;
  return static_cast<unsigned>(
      std::bit_floor(static_cast<std::uint64_t>(std::clamp<std::int64_t>(most, 1, kMostSlots))));
}

// Streams by offset: each goes to the residue with the fewest data so far, the lowest of those.
class SlotLoads {
 public:
  explicit SlotLoads(unsigned slots) : loads_(slots) {}

  unsigned place(unsigned every) {
    // Those before have the same or a shorter period: all slots of a residue have the same load.
    const auto end = loads_.begin() + every;
    const auto offset = static_cast<unsigned>(std::min_element(loads_.begin(), end) - loads_.begin());
    for (std::size_t slot = offset; slot < loads_.size(); slot += every) ++loads_[slot];
    return offset;
  }
  std::vector<unsigned> loads() && { return std::move(loads_); }

 private:
  std::vector<unsigned> loads_;
};

void place_streams(Allocation& allocation) {
  std::vector<std::size_t> order(allocation.loops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t n) { return allocation.loops[n].every; });
  SlotLoads loads(allocation.loops[order.back()].every);
  for (const std::size_t n : order) {
    LoopShare& loop = allocation.loops[n];
    loop.sensor_offset = loads.place(loop.every);
    loop.controller_offset = loads.place(loop.every);
  }
  allocation.loads = std::move(loads).loads();
  allocation.windows = std::ranges::max(allocation.loads);
  allocation.fewest = std::ranges::min(allocation.loads);
}

void limit_packets(const Demand& demand, Allocation& allocation) {
  const unsigned queues = demand.real_time_queues;
  allocation.rotation = demand.nodes * demand.overhead;
  const Duration without_data = queues * demand.real_time_packet + allocation.rotation;
  allocation.periodic_interval = allocation.windows * demand.periodic_packet + without_data;
  const Duration room = allocation.slot - without_data;
  allocation.most_windows = room < Duration::zero()                     ? -1
                            : demand.periodic_packet > Duration::zero() ? room / demand.periodic_packet
                                                                        : std::int64_t{kMostNodes};
  const auto beside = [&](unsigned data) { return longest_beside(demand, allocation.slot, data); };
  allocation.longest_printed = beside(allocation.windows);
  // Of the lengths between two loads the shortest is at one of them: the limit is monotonous in the load.
  allocation.longest_safe = std::min(beside(std::max(allocation.fewest, 1U)), beside(allocation.windows));
  allocation.longest_from_start = std::min(beside(1), beside(allocation.windows));
  allocation.longest_for_real_time = whole_microseconds(room / std::int64_t{demand.nodes});
}

bool is_feasible(const Demand& demand) {
  return allocate(demand).is_feasible();
}

// The smallest multiple of a hundredth of the bound, up to 100 times it, that helps; the others stay.
std::optional<Duration> bound_that_fits(Demand demand, std::size_t loop) {
  const Duration bound = demand.bounds[loop];
  for (int hundredths = 101; hundredths <= 10'000; hundredths += hundredths < 400 ? 1 : 100) {
    const Duration raised = bound / 100 * hundredths;
    if (raised > kLongestBound) break;
    demand.bounds[loop] = raised;
    if (is_feasible(demand)) return raised;
  }
  return std::nullopt;
}

std::size_t loops_too_many(Demand demand) {
  std::size_t left_out = 0;
  while (!demand.bounds.empty() && !is_feasible(demand)) {
    demand.bounds.erase(std::ranges::min_element(demand.bounds));
    ++left_out;
  }
  return left_out;
}

}  // namespace

std::string_view text_of(Rule rule) {
  return rule == Rule::hong ? "hong" : "sharp";
}

std::string_view text_of(LengthRule rule) {
  return rule == LengthRule::printed ? "printed" : "safe";
}

double Allocation::mean_load() const {
  return static_cast<double>(std::accumulate(loads.begin(), loads.end(), std::uint64_t{0})) /
         static_cast<double>(loads.size());
}

double Allocation::busy_slots() const {
  return static_cast<double>(std::ranges::count_if(loads, [](unsigned load) { return load > 0; })) /
         static_cast<double>(loads.size());
}

kernel::Duration longest_beside(const Demand& demand, Duration slot, unsigned data) {
  const Duration taken = data * demand.periodic_packet + demand.real_time_queues * demand.real_time_packet +
                         demand.nodes * demand.overhead;
  return whole_microseconds((slot - taken) / (std::int64_t{demand.nodes} - data + 1));
}

Allocation allocate(const Demand& demand) {
  check_demand(demand);
  Allocation allocation;
  allocation.slot = whole_microseconds(std::ranges::min(demand.bounds) / 3);
  for (const Duration bound : demand.bounds) {
    LoopShare loop;
    loop.every = slots_between(demand.rule, bound, allocation.slot);
    loop.period = loop.every * allocation.slot;
    loop.longest_delay =
        demand.rule == Rule::hong ? 2 * loop.period + allocation.slot : loop.period + 2 * allocation.slot;
    allocation.loops.push_back(loop);
  }
  place_streams(allocation);
  limit_packets(demand, allocation);
  return allocation;
}

Remedy remedy(const Demand& demand, const Allocation& allocation) {
  Remedy found;
  found.fastest = static_cast<std::size_t>(std::ranges::min_element(demand.bounds) - demand.bounds.begin());
  found.bound = bound_that_fits(demand, found.fastest);
  const Duration real_time = demand.real_time_queues * demand.real_time_packet;
  const Duration for_data = allocation.slot - real_time - allocation.rotation;
  if (for_data > Duration::zero()) {
    const Duration packet = whole_microseconds(for_data / std::int64_t{allocation.windows});
    if (packet > Duration::zero()) found.periodic_packet = packet;
  }
  const Duration for_server = allocation.slot - real_time - allocation.windows * demand.periodic_packet;
  if (for_server > Duration::zero()) {
    const Duration overhead = whole_microseconds(for_server / std::int64_t{demand.nodes});
    if (overhead > Duration::zero()) found.overhead = overhead;
  }
  found.loops_to_leave_out = loops_too_many(demand);
  return found;
}

}  // namespace fieldproof::bandwidth
