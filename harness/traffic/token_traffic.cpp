#include "harness/traffic/token_traffic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
#include "harness/traffic/batch_means.hpp"
#include "harness/traffic/milliseconds.hpp"
#include "harness/traffic/poisson_arrivals.hpp"

namespace fieldproof::traffic {
namespace {

constexpr std::uint64_t kTrafficBatches = 100;
constexpr std::uint64_t kRotationsOfTrafficBatch = 1'000;
constexpr kernel::Duration kLongestRun = 50 * 86'400 * kernel::kSecond;

[[noreturn]] void refuse_traffic(const std::string& sentence) {
  throw kernel::Error(kernel::ErrorKind::configuration, sentence);
}

void check_stream(const PacketStream& stream) {
  const bool is_rate = stream.per_ms == 0 || (stream.per_ms >= kLeastPerMs && stream.per_ms <= kMostPerMs);
  if (!is_rate) {
    refuse_traffic(fmt::format("{} packets in a millisecond cannot be simulated; 0 or {:g} to {:g} can",
                               stream.per_ms, kLeastPerMs, kMostPerMs));
  }
  if (stream.length < kernel::Duration::zero() || stream.length > kLongestTokenTime) {
    refuse_traffic("a packet takes 0 to 1 s");
  }
}

void check_schedule(const TokenTraffic& traffic) {
  if (traffic.schedule.empty()) return;
  if (traffic.schedule.size() > kMostScheduledItems || traffic.macrocycle <= kernel::Duration::zero() ||
      traffic.macrocycle > kLongestMacrocycle) {
    refuse_traffic("a schedule has up to 256 items in a macrocycle of up to 60 s");
  }
  kernel::Duration free_from{};
  kernel::Duration longest_gap{};
  for (const ScheduledItem& item : traffic.schedule) {
    if (item.length <= kernel::Duration::zero() || item.length > traffic.macrocycle ||
        item.offset < free_from || item.offset > traffic.macrocycle - item.length) {
      refuse_traffic(fmt::format(
          "the scheduled item at {} begins before the end of the one in front of it, or ends after the "
          "macrocycle; items stand in the order of their times",
          kernel::describe(item.offset)));
    }
    if (free_from > kernel::Duration::zero()) longest_gap = std::max(longest_gap, item.offset - free_from);
    free_from = item.offset + item.length;
  }
  longest_gap = std::max(longest_gap, traffic.macrocycle - free_from + traffic.schedule.front().offset);
  kernel::Duration needed = traffic.idle;
  for (const TokenNode& node : traffic.nodes) needed = std::max(needed, node.overhead);
  if (longest_gap < needed) {
    refuse_traffic(fmt::format("the schedule leaves {} at once, and the token needs {} at a node",
                               kernel::describe(longest_gap), kernel::describe(needed)));
  }
  for (const TokenNode& node : traffic.nodes) {
    for (const PacketStream& stream : node.streams) {
      if (stream.per_ms == 0 || stream.length <= longest_gap) continue;
      refuse_traffic(fmt::format("a packet of {} never goes: the schedule leaves {} at once",
                                 kernel::describe(stream.length), kernel::describe(longest_gap)));
    }
  }
}

// The share of what is 1 that is held with 97.5 %. Misses come together: what is counted are the batches that
// have some, whose number is at most (sqrt(c + 1) + 0.98)^2 with that confidence, also when there was none.
double least_share(const BatchMeans& within) {
  if (within.count() == 0) return 0;
  const auto values = static_cast<double>(within.count());
  const double missed = values * (1 - within.mean());
  const auto batches =
      static_cast<double>(std::ranges::count_if(within.means(), [](double m) { return m < 1; }));
  double most = missed + 1.96 * values * within.standard_error();
  if (batches <= static_cast<double>(within.batches()) / 2) {
    const double most_batches = std::pow(std::sqrt(batches + 1) + 0.98, 2);
    const double in_batch = batches > 0 ? std::max(1.0, missed / batches) : 1;
    most = std::max(most, most_batches * in_batch);
  }
  return std::max(0.0, 1 - most / values);
}

// When the next scheduled item goes.
class NextItem {
 public:
  explicit NextItem(const TokenTraffic& traffic) : traffic_(&traffic) { place(); }
  kernel::Time begin() const { return begin_; }
  kernel::Time end() const { return begin_ + traffic_->schedule[at_].length; }
  void advance() {
    if (++at_ == traffic_->schedule.size()) {
      at_ = 0;
      cycle_ += traffic_->macrocycle;
    }
    place();
  }

 private:
  void place() {
    if (!traffic_->schedule.empty()) begin_ = cycle_ + traffic_->schedule[at_].offset;
  }
  const TokenTraffic* traffic_;
  std::size_t at_ = 0;
  kernel::Time cycle_ = kernel::kStart;
  kernel::Time begin_ = kernel::kNever;
};

class StreamQueue {
 public:
  StreamQueue(const PacketStream& stream, const kernel::Random& random, std::uint64_t batch)
      : stream_(stream), arrivals_(stream.per_ms, random), delays_(batch), within_(batch) {}

  bool has_packet(kernel::Time now) {
    for (; arrivals_.next() <= now; arrivals_.draw()) {
      if (waiting_.size() >= kMostQueued) {
        has_overflowed_ = true;
        break;
      }
      waiting_.push_back(arrivals_.next());
    }
    return !waiting_.empty();
  }
  kernel::Duration length() const { return stream_.length; }

  // The delay of the packet that ends then.
  kernel::Duration take(kernel::Time end) {
    const kernel::Duration delay = end - waiting_.front();
    waiting_.pop_front();
    return delay;
  }
  void count(kernel::Duration delay, bool is_within) {
    delays_.add(ms(delay));
    within_.add(is_within ? 1 : 0);
    largest_ = std::max(largest_, delay);
  }
  void begin_counting(kernel::Time now) {
    has_packet(now);
    waiting_before_ = waiting_.size();
  }

  StreamFigures figures(kernel::Time now, kernel::Duration counted) {
    has_packet(now);
    StreamFigures it;
    it.is_unstable = has_overflowed_ || grows(ms(counted)) || delays_.grows() || is_starved(now, counted);
    it.packets = delays_.count();
    it.batches = delays_.batches();
    it.mean_delay = delays_.mean();
    it.standard_error = delays_.standard_error();
    it.largest_delay = ms(largest_);
    it.within = within_.mean();
    it.least_within = least_share(within_);
    it.arrive_per_ms = stream_.per_ms;
    it.leave_per_ms = counted.count() > 0 ? static_cast<double>(it.packets) / ms(counted) : 0;
    it.waiting = waiting_.size();
    return it;
  }

 private:
  // Beyond what chance makes of a queue that is stable: six standard deviations of what arrived.
  bool grows(double counted_ms) const {
    constexpr double kFew = 50;
    const double growth = static_cast<double>(waiting_.size()) - static_cast<double>(waiting_before_);
    return growth > kFew && growth > 6 * std::sqrt(stream_.per_ms * counted_ms);
  }

  // One has waited for more than half of the time, and none was sent.
  bool is_starved(kernel::Time now, kernel::Duration counted) const {
    return delays_.count() == 0 && !waiting_.empty() && counted > kernel::Duration::zero() &&
           2 * (now - waiting_.front()) > counted;
  }

  PacketStream stream_;
  PoissonArrivals arrivals_;
  std::deque<kernel::Time> waiting_{};
  BatchMeans delays_;
  BatchMeans within_;
  kernel::Duration largest_{};
  std::size_t waiting_before_ = 0;
  bool has_overflowed_ = false;
};

// What one priority has over all nodes.
struct PriorityTotal {
  explicit PriorityTotal(std::uint64_t batch) : delays(batch), within(batch) {}
  BatchMeans delays;
  BatchMeans within;
  kernel::Duration largest{};
};

class TokenPath {
 public:
  TokenPath(const TokenTraffic& traffic, const TrafficRun& run)
      : traffic_(traffic), run_(run), item_(traffic_) {
    const kernel::Random random(run.seed);
    double urgent_per_ms = 0;
    for (const TokenNode& node : traffic.nodes) urgent_per_ms += node.streams[kUrgent].per_ms;
    std::array<double, kTokenPriorities> expected{};
    for (unsigned p = 0; p < kTokenPriorities; ++p) {
      const kernel::Random of_priority = random.split(name_of(static_cast<TokenPriority>(p)));
      for (std::size_t n = 0; n < traffic.nodes.size(); ++n) {
        const PacketStream& stream = traffic.nodes[n].streams[p];
        const double packets = static_cast<double>(run.urgent_packets) * stream.per_ms / urgent_per_ms;
        expected[p] += packets;
        queues_[p].emplace_back(stream, of_priority.split(n), batch_of(packets));
      }
    }
    expected[kUrgent] = static_cast<double>(run.urgent_packets);
    for (const double packets : expected) totals_.emplace_back(batch_of(packets));
  }

  TrafficFigures rotate() {
    const std::size_t nodes = traffic_.nodes.size();
    std::size_t at = 0;
    for (std::uint64_t visit = 0; visit < run_.visits && goes_on(); ++visit) {
      this->visit(at);
      if (++at == nodes) {
        at = 0;
        end_rotation();
      }
    }
    return figures();
  }

 private:
  static std::uint64_t batch_of(double packets) {
    return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(packets) / kTrafficBatches);
  }
  bool goes_on() const {
    return totals_[kUrgent].delays.count() < run_.urgent_packets && now_ - kernel::kStart < kLongestRun;
  }

  // The token goes on, after all items that it would meet.
  void spend(kernel::Duration duration) {
    while (now_ + duration > item_.begin()) {
      if (is_counting_) waited_ += item_.begin() - now_;
      now_ = item_.end();
      item_.advance();
    }
    now_ += duration;
  }

  void visit(std::size_t at) {
    spend(traffic_.nodes[at].overhead);
    for (unsigned p = 0; p <= lowest_admitted_; ++p) send(queues_[p][at], totals_[p]);
  }

  void send(StreamQueue& queue, PriorityTotal& total) {
    if (!queue.has_packet(now_) || now_ + queue.length() > item_.begin()) return;
    now_ += queue.length();
    const kernel::Duration delay = queue.take(now_);
    if (!is_counting_) return;
    const bool is_within = delay <= run_.bound;
    queue.count(delay, is_within);
    total.delays.add(ms(delay));
    total.within.add(is_within ? 1 : 0);
    total.largest = std::max(total.largest, delay);
  }

  void end_rotation() {
    spend(traffic_.idle);
    const kernel::Duration rotation = now_ - rotation_start_;
    if (is_counting_) {
      lengths_.add(ms(rotation));
      longest_ = std::max(longest_, rotation);
      ++admitted_to_[lowest_admitted_];
      counted_waits_ = waited_;
    }
    lowest_admitted_ = next_admitted(rotation < traffic_.target);
    rotation_start_ = now_;
    if (!is_counting_ && ++warm_up_ >= run_.warm_up_rotations) begin_counting();
  }

  unsigned next_admitted(bool was_short) const {
    if (traffic_.rule == TokenRule::all_or_urgent) return was_short ? kTimeAvailable : kUrgent;
    if (was_short) return std::min<unsigned>(lowest_admitted_ + 1, kTimeAvailable);
    return lowest_admitted_ == kUrgent ? kUrgent : lowest_admitted_ - 1;
  }

  void begin_counting() {
    is_counting_ = true;
    counted_from_ = now_;
    for (auto& queues : queues_) {
      for (StreamQueue& queue : queues) queue.begin_counting(now_);
    }
  }

  TrafficFigures figures() {
    TrafficFigures it;
    const kernel::Duration counted = is_counting_ ? now_ - counted_from_ : kernel::Duration{};
    it.nodes.resize(traffic_.nodes.size());
    for (unsigned p = 0; p < kTokenPriorities; ++p) {
      for (std::size_t n = 0; n < it.nodes.size(); ++n) it.nodes[n][p] = queues_[p][n].figures(now_, counted);
      it.all[p] = figures_of_all(p, it);
    }
    it.rotations = lengths_.count();
    if (it.rotations == 0) return it;
    it.mean_rotation = lengths_.mean();
    it.rotation_error = lengths_.standard_error();
    it.longest_rotation = ms(longest_);
    for (unsigned p = 0; p < kTokenPriorities; ++p) {
      it.admitted_to[p] = static_cast<double>(admitted_to_[p]) / static_cast<double>(it.rotations);
    }
    it.waits_for_schedule = ms(counted_waits_) / ms(rotation_start_ - counted_from_);
    return it;
  }

  StreamFigures figures_of_all(unsigned priority, const TrafficFigures& figures) const {
    StreamFigures all;
    for (const auto& node : figures.nodes) all.is_unstable |= node[priority].is_unstable;
    if (all.is_unstable) return all;
    const PriorityTotal& total = totals_[priority];
    all.packets = total.delays.count();
    all.batches = total.delays.batches();
    all.mean_delay = total.delays.mean();
    all.standard_error = total.delays.standard_error();
    all.largest_delay = ms(total.largest);
    all.within = total.within.mean();
    all.least_within = least_share(total.within);
    for (const auto& node : figures.nodes) {
      all.arrive_per_ms += node[priority].arrive_per_ms;
      all.leave_per_ms += node[priority].leave_per_ms;
      all.waiting += node[priority].waiting;
    }
    return all;
  }

  const TokenTraffic traffic_;
  const TrafficRun run_;
  std::array<std::vector<StreamQueue>, kTokenPriorities> queues_;
  std::vector<PriorityTotal> totals_;
  kernel::Duration longest_{};
  BatchMeans lengths_{kRotationsOfTrafficBatch};
  NextItem item_;

  kernel::Time now_ = kernel::kStart;
  kernel::Time rotation_start_ = kernel::kStart;
  unsigned lowest_admitted_ = kTimeAvailable;
  std::uint64_t warm_up_ = 0;
  bool is_counting_ = false;
  kernel::Time counted_from_ = kernel::kStart;
  kernel::Duration waited_{};
  kernel::Duration counted_waits_{};
  std::array<std::uint64_t, kTokenPriorities> admitted_to_{};
};

}  // namespace

const char* name_of(TokenPriority priority) {
  switch (priority) {
    case kUrgent:
      return "urgent";
    case kNormal:
      return "normal";
    case kTimeAvailable:
      return "time-available";
  }
  return "";
}

kernel::Duration TokenTraffic::empty_rotation() const {
  kernel::Duration sum = idle;
  for (const TokenNode& node : nodes) sum += node.overhead;
  return sum;
}

double TokenTraffic::load() const {
  double sum = 0;
  for (const TokenNode& node : nodes) {
    for (const PacketStream& stream : node.streams) sum += stream.per_ms * ms(stream.length);
  }
  return sum;
}

double TokenTraffic::scheduled_load() const {
  double sum = 0;
  for (const ScheduledItem& item : schedule) sum += ms(item.length) / ms(macrocycle);
  return sum;
}

void check(const TokenTraffic& traffic) {
  if (traffic.nodes.empty() || traffic.nodes.size() > kMostTokenNodes) {
    refuse_traffic("a token has 1 to 64 nodes to go to");
  }
  for (const TokenNode& node : traffic.nodes) {
    if (node.overhead < kernel::kNanosecond || node.overhead > kLongestTokenTime) {
      refuse_traffic("the token takes 1 ns to 1 s at a node");
    }
    for (const PacketStream& stream : node.streams) check_stream(stream);
  }
  if (traffic.idle < kernel::Duration::zero() || traffic.idle > kLongestTokenTime ||
      traffic.target < kernel::Duration::zero()) {
    refuse_traffic("a rotation has 0 to 1 s besides its nodes, and no negative target");
  }
  check_schedule(traffic);
}

TrafficFigures pass_token(const TokenTraffic& traffic, const TrafficRun& run) {
  check(traffic);
  const bool has_urgent = std::ranges::any_of(
      traffic.nodes, [](const TokenNode& node) { return node.streams[kUrgent].per_ms > 0; });
  if (run.urgent_packets < kTrafficBatches || !has_urgent) {
    refuse_traffic("a run of the token counts 100 urgent packets or more, and some have to come");
  }
  return TokenPath(traffic, run).rotate();
}

}  // namespace fieldproof::traffic
