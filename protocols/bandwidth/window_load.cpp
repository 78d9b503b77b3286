#include "protocols/bandwidth/window_load.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "harness/traffic/milliseconds.hpp"

namespace fieldproof::bandwidth {
namespace {

using kernel::Duration;
using kernel::Time;

constexpr std::int64_t kMostFillers = 16;

// When the last datum of a slot is sent whose begin found the server on its way into a packet at this node.
Duration last_datum_from(const WindowTraffic& traffic, const std::vector<bool>& has_data, unsigned from,
                         const std::vector<bool>& has_non_real_time, const std::vector<bool>& has_real_time) {
  Duration now = has_non_real_time[from] ? traffic.non_real_time_packet : Duration::zero();
  Duration last{};
  bool is_periodic = false;
  bool was_silent = false;
  for (unsigned n = 1; n <= traffic.nodes; ++n) {
    const unsigned node = (from + n) % traffic.nodes;
    now += traffic.overhead + (was_silent ? traffic.empty_answer : Duration::zero());
    was_silent = true;
    if (has_real_time[node]) now += traffic.real_time_packet;
    if (has_data[node]) {
      is_periodic = true;
      was_silent = false;
      last = now += traffic.periodic_packet;
    } else if (has_non_real_time[node] && !is_periodic) {
      was_silent = false;
      now += traffic.non_real_time_packet;
    }
  }
  return last;
}

struct WorstBegin {
  Duration delay{};
  std::uint8_t node = 0;
};

std::vector<bool> at_nodes(unsigned nodes, const std::vector<QueueTraffic>& queues) {
  std::vector<bool> has(nodes, false);
  for (const QueueTraffic& queue : queues) has[queue.node] = true;
  return has;
}

WorstBegin worst_begin(const WindowTraffic& traffic, std::uint64_t slot) {
  std::vector<bool> has_data(traffic.nodes, false);
  for (const std::uint8_t node : traffic.nodes_with_data(slot)) has_data[node] = true;
  const auto non_real_time = at_nodes(traffic.nodes, traffic.non_real_time);
  const auto real_time = at_nodes(traffic.nodes, traffic.real_time);
  WorstBegin worst;
  for (unsigned node = 0; node < traffic.nodes; ++node) {
    const Duration delay = last_datum_from(traffic, has_data, node, non_real_time, real_time);
    if (delay > worst.delay) worst = {delay, static_cast<std::uint8_t>(node)};
  }
  return worst;
}

double per_ms(Duration mean_gap) {
  return mean_gap > Duration::zero() ? 1 / traffic::ms(mean_gap) : 0;
}

}  // namespace

Duration slowest_datum(const WindowTraffic& traffic, std::uint64_t slot) {
  return worst_begin(traffic, slot).delay;
}

// ---- the slot ----

SlotView::SlotView(const WindowTraffic& traffic)
    : traffic_(traffic), worst_(traffic.repeats_after(), -1), end_(kernel::kStart + traffic.slot) {
  for (std::uint64_t slot = 0; slot < traffic.repeats_after(); ++slot)
    loads_.push_back(static_cast<unsigned>(traffic.nodes_with_data(slot).size()));
  left_ = loads_.front();
}

std::uint8_t SlotView::worst_of_next() const {
  int& worst = worst_[(slot_ + 1) % worst_.size()];
  if (worst < 0) worst = worst_begin(traffic_, slot_ + 1).node;
  return static_cast<std::uint8_t>(worst);
}

void SlotView::next_slot() {
  end_ += traffic_.slot;
  ++slot_;
  left_ = loads_[slot_ % loads_.size()];
}

// ---- the queues ----

QueueSet::QueueSet(const WindowTraffic& traffic, const std::vector<QueueTraffic>& queues, Load load,
                   Duration packet, const kernel::Random& random)
    : load_(load),
      packet_(packet),
      step_(traffic.overhead + traffic.empty_answer),
      step_of_packet_(traffic.overhead + packet),
      nodes_(traffic.nodes),
      place_(traffic.nodes, -1),
      random_(random.split("draws")) {
  if (load == Load::none) return;
  for (const QueueTraffic& queue : queues) {
    place_[queue.node] = static_cast<int>(timed_.size());
    free_from_.push_back(kernel::kStart);
    timed_.push_back({traffic::PoissonArrivals(per_ms(queue.mean_gap), random.split(queue.node))});
  }
}

bool QueueSet::offers(std::uint8_t node, Time now, const SlotView& slot) {
  if (place_[node] < 0) return false;
  switch (load_) {
    case Load::none:
      return false;
    case Load::arriving:
      return has_arrived(node, now);
    case Load::saturated:
      return true;
    case Load::random:
      return is_drawn(node, slot);
    case Load::just_late:
      return is_just_late(node, now, slot);
  }
  return false;
}

bool QueueSet::has_arrived(std::uint8_t node, Time now) {
  traffic::TimedQueue& queue = timed_[static_cast<std::size_t>(place_[node])];
  queue.fill(now);
  return !queue.waiting.empty();
}

bool QueueSet::is_drawn(std::uint8_t, const SlotView& slot) {
  constexpr std::array kProbabilities{0.0, 0.02, 0.1, 0.5, 0.9, 1.0};
  if (drawn_for_ != slot.slot()) {
    drawn_for_ = slot.slot();
    probability_ = kProbabilities.at(random_.below(kProbabilities.size()));
  }
  return random_.chance(probability_);
}

// While data of the slot wait, all send; after them as many packets as bring the server to the aim shortly
// before the end of the slot, and one there.
bool QueueSet::is_just_late(std::uint8_t node, Time now, const SlotView& slot) {
  if (slot.left() > 0) return true;
  if (aimed_for_ != slot.slot()) {
    aimed_for_ = slot.slot();
    aim(node, now, slot);
  }
  if (fillers_ > 0) return true;
  return node == slot.worst_of_next() && now + std::int64_t{nodes_} * step_ >= slot.end();
}

void QueueSet::aim(std::uint8_t node, Time now, const SlotView& slot) {
  const Duration round = std::int64_t{nodes_} * step_;
  const Duration until = slot.end() - now;
  Duration nearest = Duration::max();
  fillers_ = 0;
  const std::int64_t most =
      packet_ > Duration::zero() ? std::min<std::int64_t>(until / step_of_packet_, kMostFillers) : 0;
  for (std::int64_t fillers = 0; fillers <= most; ++fillers) {
    const auto visits = (std::int64_t{slot.worst_of_next()} - node - fillers) % std::int64_t{nodes_};
    const Duration first = fillers * step_of_packet_ + (visits < 0 ? visits + nodes_ : visits) * step_;
    const Duration left = until - first;
    if (left <= Duration::zero()) continue;
    // The last visit to the aim that begins before the end.
    const Duration rest = (left - kernel::kPicosecond) % round + kernel::kPicosecond;
    if (rest >= nearest) continue;
    nearest = rest;
    fillers_ = static_cast<unsigned>(fillers);
  }
}

void QueueSet::on_sent(std::uint8_t node, Time end) {
  ++figures_.sent;
  if (fillers_ > 0) --fillers_;
  if (load_ != Load::arriving) return;
  const auto place = static_cast<std::size_t>(place_[node]);
  std::deque<Time>& waiting = timed_[place].waiting;
  figures_.longest = std::max(figures_.longest, end - std::max(waiting.front(), free_from_[place]));
  free_from_[place] = end;
  waiting.pop_front();
}

void QueueSet::begin_counting(Time now) {
  figures_ = {};
  counted_from_ = now;
  if (load_ != Load::arriving) return;
  waiting_before_ = figures(now, false).waiting;
}

QueueFigures QueueSet::figures(Time now, bool tells_growth) {
  QueueFigures figures = figures_;
  if (load_ != Load::arriving) return figures;
  for (traffic::TimedQueue& queue : timed_) {
    queue.fill(now);
    figures.waiting += queue.waiting.size();
  }
  if (!tells_growth) return figures;
  // Beyond what chance makes of queues that are stable: six standard deviations of what arrived.
  constexpr double kFew = 50;
  const double growth = static_cast<double>(figures.waiting) - static_cast<double>(waiting_before_);
  const double arrived = growth + static_cast<double>(figures.sent);
  figures.grows = growth > kFew && growth > 6 * std::sqrt(std::max(arrived, 0.0));
  return figures;
}

}  // namespace fieldproof::bandwidth
