// Subject: the simulation of windows against another one, which goes from instant to instant and keeps all in
// plain lists.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <tuple>
#include <vector>

#include "harness/kernel/random.hpp"
#include "harness/kernel/sanitized.hpp"
#include "protocols/bandwidth/window_traffic.hpp"

namespace fieldproof::bandwidth {
namespace {

struct Delivery {
  int node;
  std::int64_t generated;
  std::int64_t end;
  auto operator<=>(const Delivery&) const = default;
};

struct Books {
  std::vector<Delivery> deliveries;
  std::int64_t vacant = 0, lost = 0, replaced = 0;
};

// Times in picoseconds. Non-real-time and real-time queues of the given nodes always have a packet.
class Oracle {
 public:
  explicit Oracle(const WindowTraffic& traffic) : t_(traffic), loops_(traffic.loops.size()) {
    for (const QueueTraffic& queue : traffic.non_real_time) has_big_[queue.node] = true;
    for (const QueueTraffic& queue : traffic.real_time) has_small_[queue.node] = true;
  }

  Books run(std::int64_t until, std::int64_t counts_from) {
    counts_from_ = counts_from;
    for (std::size_t n = 0; n < loops_.size(); ++n) {
      const LoopTraffic& loop = t_.loops[n];
      for (std::int64_t k = 0;; ++k) {
        const std::int64_t base = (k * loop.every) * t_.slot.count();
        if (base > until) break;
        events_.emplace_back(base + loop.sensor_offset * t_.slot.count(), 1, n, false);
        events_.emplace_back(base + loop.controller_offset * t_.slot.count() + loop.skew.count(), 1, n, true);
      }
    }
    std::sort(events_.begin(), events_.end());
    int pb = -1;  // who has begun the periodic interval
    std::int64_t now = 0;
    for (unsigned node = 0; now < until; node = (node + 1) % t_.nodes) {
      const auto at = static_cast<int>(node);
      bool silent = true;
      if (pb == at) pb = -1;
      if (has_small_[at]) {
        now += t_.real_time_packet.count();
      }
      happen_until(now);
      if (place_.contains(at)) {
        silent = false;
        if (pb < 0) pb = at;
        const auto [generated, sample, loop, is_controller] = place_[at];
        place_.erase(at);
        now += t_.periodic_packet.count();
        books_.deliveries.push_back({at, generated, now});
        if (!is_controller) deliver(now, loop, sample);
      } else if (has_big_[at] && pb < 0) {
        now += t_.non_real_time_packet.count();
        silent = false;
      }
      now += t_.overhead.count() + (silent ? t_.empty_answer.count() : 0);
    }
    return books_;
  }

 private:
  struct Known {
    std::vector<std::int64_t> inbox{};  // samples that have come since the last sampling
    std::int64_t newest = -1;
  };

  // Arrivals come before samplings of the same instant.
  void deliver(std::int64_t when, std::size_t loop, std::int64_t sample) {
    pending_.emplace_back(when, loop, sample);
  }

  void happen_until(std::int64_t now) {
    while (next_ < events_.size() && std::get<0>(events_[next_]) <= now) {
      const auto [when, order, n, is_controller] = events_[next_++];
      while (!pending_.empty() && std::get<0>(pending_.front()) <= when) {
        const auto [arrival, loop, sample] = pending_.front();
        pending_.pop_front();
        loops_[loop].inbox.push_back(sample);
      }
      const LoopTraffic& loop = t_.loops[n];
      const int node = is_controller ? loop.controller : loop.sensor;
      std::int64_t sample = when;
      if (is_controller) {
        Known& known = loops_[n];
        if (known.newest < 0 && known.inbox.empty()) continue;
        if (when >= counts_from_) {
          if (known.inbox.empty()) ++books_.vacant;
          if (known.inbox.size() > 1) books_.lost += static_cast<std::int64_t>(known.inbox.size()) - 1;
        }
        if (!known.inbox.empty()) known.newest = known.inbox.back();
        known.inbox.clear();
        sample = known.newest;
      }
      if (place_.contains(node) && when >= counts_from_) ++books_.replaced;
      place_[node] = {when, sample, n, is_controller};
    }
  }

  const WindowTraffic& t_;
  std::vector<Known> loops_;
  std::map<int, bool> has_big_, has_small_;
  std::vector<std::tuple<std::int64_t, int, std::size_t, bool>> events_;
  std::size_t next_ = 0;
  std::map<int, std::tuple<std::int64_t, std::int64_t, std::size_t, bool>> place_;
  std::deque<std::tuple<std::int64_t, std::size_t, std::int64_t>> pending_;
  std::int64_t counts_from_ = 0;
  Books books_;
};

WindowTraffic drawn_traffic(kernel::Random& random) {
  const auto us = [&](std::int64_t low, std::int64_t high) {
    return random.between(low, high) * kernel::kMicrosecond;
  };
  WindowTraffic traffic;
  const auto loops = static_cast<unsigned>(random.between(1, 4));
  traffic.nodes = 2 * loops + static_cast<unsigned>(random.between(0, 4));
  traffic.slot = us(2'000, 6'000);
  traffic.overhead = us(1, 90);
  if (random.chance(0.5)) traffic.empty_answer = us(1, 50);
  traffic.periodic_packet = us(10, 400);
  traffic.real_time_packet = us(5, 60);
  traffic.non_real_time_packet = us(50, 1'500);
  std::vector<std::uint8_t> nodes;
  for (unsigned n = 0; n < traffic.nodes; ++n) nodes.push_back(static_cast<std::uint8_t>(n));
  random.shuffle(nodes);
  for (unsigned n = 0; n < loops; ++n) {
    LoopTraffic loop{.sensor = nodes[2 * n], .controller = nodes[2 * n + 1]};
    loop.every = 1U << random.below(4);
    loop.sensor_offset = static_cast<unsigned>(random.below(loop.every));
    loop.controller_offset = static_cast<unsigned>(random.below(loop.every));
    if (random.chance(0.5)) {
      loop.skew = kernel::Duration{
          static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(traffic.slot.count())))};
    }
    traffic.loops.push_back(loop);
  }
  for (unsigned n = 0; n < traffic.nodes; ++n) {
    if (random.chance(0.7)) traffic.non_real_time.push_back({.node = static_cast<std::uint8_t>(n)});
    if (random.chance(0.2)) traffic.real_time.push_back({.node = static_cast<std::uint8_t>(n)});
  }
  return traffic;
}

// Overloaded networks, skews and polling included: every delivery is the same to the picosecond.
TEST(WindowOracle, BothSimulationsDeliverTheSame) {
  kernel::Random random(1);
  constexpr int kNetworks = kernel::kIsSanitized ? 40 : 1'000;
  std::uint64_t late = 0, vacant = 0;
  for (int n = 0; n < kNetworks; ++n) {
    const WindowTraffic traffic = drawn_traffic(random);
    constexpr std::uint64_t kCounted = 60;
    std::vector<Delivery> deliveries;
    WindowRun run{.slots = kCounted, .real_time = Load::saturated, .non_real_time = Load::saturated};
    run.on_sent = [&](const Sent& sent) {
      if (sent.packet != Packet::periodic) return;
      deliveries.push_back(
          {sent.node, sent.generated.time_since_epoch().count(), sent.end.time_since_epoch().count()});
    };
    const WindowFigures figures = run_windows(traffic, run);
    const std::int64_t counts_from =
        static_cast<std::int64_t>(slots_of_start(traffic)) * traffic.slot.count();
    const std::int64_t until = counts_from + static_cast<std::int64_t>(kCounted) * traffic.slot.count();
    const Books books = Oracle(traffic).run(until, counts_from);
    ASSERT_EQ(deliveries, books.deliveries) << n;
    // What has happened since the last look at a node is not in the figures yet.
    std::uint64_t replaced = 0;
    for (const StreamFigures& stream : figures.streams) replaced += stream.replaced;
    EXPECT_NEAR(static_cast<double>(figures.vacant()), static_cast<double>(books.vacant), 4) << n;
    EXPECT_NEAR(static_cast<double>(figures.lost() - replaced), static_cast<double>(books.lost), 8) << n;
    EXPECT_NEAR(static_cast<double>(replaced), static_cast<double>(books.replaced), 8) << n;
    late += figures.over_slot();
    vacant += figures.vacant();
  }
  EXPECT_GT(late, 0U);
  EXPECT_GT(vacant, 0U);
}

// The slowest datum in closed form is reached, and never passed: each begin in a packet, on each phase of it.
TEST(WindowOracle, NoDatumOfASlotIsSlowerThanTheSlowest) {
  kernel::Random random(2);
  constexpr int kNetworks = kernel::kIsSanitized ? 10 : 80;
  int reached = 0;
  for (int n = 0; n < kNetworks; ++n) {
    WindowTraffic traffic = drawn_traffic(random);
    traffic.slot = 60'000 * kernel::kMicrosecond;  // room for all, so that each slot begins without data
    traffic.overhead += 200 * kernel::kMicrosecond;
    traffic.empty_answer = {};
    for (LoopTraffic& loop : traffic.loops) loop.skew = {};
    kernel::Duration slowest{};
    for (std::uint64_t slot = 0; slot < traffic.repeats_after(); ++slot)
      slowest = std::max(slowest, slowest_datum(traffic, slot));
    kernel::Duration longest{};
    for (unsigned phase = 0; phase < 12; ++phase) {
      WindowRun run{.seed = phase, .slots = 200};
      run.real_time = run.non_real_time = phase < 4   ? Load::saturated
                                          : phase < 8 ? Load::random
                                                      : Load::just_late;
      run.first_node = static_cast<std::uint8_t>(phase % traffic.nodes);
      longest = std::max(longest, run_windows(traffic, run).longest());
    }
    EXPECT_LE(longest, slowest) << n;
    if (longest + longest / 10 >= slowest) ++reached;
  }
  EXPECT_GT(reached, kNetworks * 8 / 10);
}

}  // namespace
}  // namespace fieldproof::bandwidth
