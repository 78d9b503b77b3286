#include "harness/traffic/token_rotation.hpp"

#include <algorithm>
#include <vector>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/scheduler.hpp"
#include "harness/traffic/arrival_queues.hpp"
#include "harness/traffic/batch_means.hpp"
#include "harness/traffic/milliseconds.hpp"

namespace fieldproof::traffic {
namespace {

constexpr std::uint64_t kRotationsOfBatch = 1'000;

class Token final : private kernel::Timer {
 public:
  Token(const UrgentTraffic& traffic, const TokenRun& run)
      : traffic_(traffic),
        run_(run),
        nodes_(std::max(traffic.urgent_queues, traffic.available_queues)),
        overhead_(traffic.empty_rotation / nodes_),
        rest_(traffic.empty_rotation - nodes_ * overhead_),
        delays_(run.urgent_packets / kBatches),
        slot_(scheduler_.add(*this)) {
    const kernel::Random random(run.seed);
    const kernel::Random of_urgent = random.split("urgent");
    const kernel::Random of_available = random.split("time-available");
    for (unsigned n = 0; n < traffic.urgent_queues; ++n) {
      urgent_.push_back({PoissonArrivals(traffic.urgent_per_ms, of_urgent.split(n))});
    }
    for (unsigned n = 0; n < traffic.available_queues; ++n) {
      available_.push_back({PoissonArrivals(traffic.available_per_ms, of_available.split(n))});
    }
  }

  TokenFigures rotate() {
    scheduler_.arm(slot_, kernel::kStart + overhead_);
    while (delays_.count() < run_.urgent_packets && !is_urgent_unstable_) scheduler_.step();
    return figures();
  }

 private:
  // The token is at a node.
  void on_time(kernel::Time now) override {
    kernel::Time end = send_urgent(now);
    end = send_available(end);
    if (++at_ == nodes_) end = end_rotation(end);
    scheduler_.arm(slot_, end + overhead_);
  }

  kernel::Time send_urgent(kernel::Time now) {
    if (at_ >= urgent_.size()) return now;
    TimedQueue& queue = urgent_[at_];
    queue.fill(now);
    if (queue.waiting.empty()) return now;
    const kernel::Time end = now + traffic_.urgent_length;
    if (is_counting_) delays_.add(ms(end - queue.waiting.front()));
    is_urgent_unstable_ = queue.waiting.size() >= kMostWaiting;
    queue.waiting.pop_front();
    return end;
  }

  kernel::Time send_available(kernel::Time now) {
    if (at_ >= available_.size() || !has_priority_1_) return now;
    if (!run_.is_available_backlogged) {
      CountedQueue& queue = available_[at_];
      queue.fill(now);
      if (queue.waiting == 0) return now;
      --queue.waiting;
    }
    if (is_counting_) ++available_sent_;
    return now + traffic_.available_length;
  }

  kernel::Time end_rotation(kernel::Time now) {
    at_ = 0;
    const kernel::Time end = now + rest_;
    if (is_counting_) {
      lengths_.add(ms(end - rotation_start_));
      rotations_1_ += has_priority_1_ ? 1 : 0;
    }
    has_priority_1_ = end - rotation_start_ < traffic_.target_rotation;
    rotation_start_ = end;
    if (!is_counting_ && ++warm_up_ >= run_.warm_up_rotations) {
      is_counting_ = true;
      counted_from_ = end;
    }
    return end;
  }

  TokenFigures figures() {
    const double time = ms(rotation_start_ - counted_from_);
    TokenFigures it;
    it.is_urgent_unstable = is_urgent_unstable_;
    it.urgent_packets = delays_.count();
    it.mean_delay = delays_.mean();
    it.standard_error = delays_.standard_error();
    if (lengths_.count() > 0) {
      it.mean_rotation = lengths_.mean();
      it.rotation_error = lengths_.standard_error();
      it.priority_1 = static_cast<double>(rotations_1_) / static_cast<double>(lengths_.count());
      it.urgent_per_ms = static_cast<double>(delays_.count()) / time / traffic_.urgent_queues;
      if (traffic_.available_queues > 0) {
        it.available_per_ms = static_cast<double>(available_sent_) / time / traffic_.available_queues;
      }
    }
    for (CountedQueue& queue : available_) {
      queue.fill(rotation_start_);
      it.longest_available = std::max(it.longest_available, queue.waiting);
    }
    return it;
  }

  const UrgentTraffic traffic_;
  const TokenRun run_;
  unsigned nodes_;
  kernel::Duration overhead_;  // of a node
  kernel::Duration rest_;      // of the division, once in a rotation
  std::vector<TimedQueue> urgent_;
  std::vector<CountedQueue> available_;
  BatchMeans delays_;
  BatchMeans lengths_{kRotationsOfBatch};
  kernel::Scheduler scheduler_;
  kernel::SlotId slot_;

  unsigned at_ = 0;
  bool has_priority_1_ = true;
  kernel::Time rotation_start_ = kernel::kStart;
  std::uint64_t warm_up_ = 0;
  bool is_counting_ = false;
  kernel::Time counted_from_ = kernel::kStart;
  std::uint64_t rotations_1_ = 0;
  std::uint64_t available_sent_ = 0;
  bool is_urgent_unstable_ = false;
};

}  // namespace

TokenFigures rotate_token(const UrgentTraffic& traffic, const TokenRun& run) {
  check(traffic);
  if (run.urgent_packets < kBatches || traffic.urgent_per_ms == 0) {
    throw kernel::Error(kernel::ErrorKind::configuration,
                        "a run of the token counts 100 urgent packets or more, and some have to come");
  }
  return Token(traffic, run).rotate();
}

double available_capacity(const UrgentTraffic& traffic, std::uint64_t seed) {
  constexpr std::uint64_t kPackets = 200'000;
  return rotate_token(traffic, {.seed = seed, .urgent_packets = kPackets, .is_available_backlogged = true})
      .available_per_ms;
}

}  // namespace fieldproof::traffic
