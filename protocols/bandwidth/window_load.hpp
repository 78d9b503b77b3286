#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/kernel/random.hpp"
#include "harness/traffic/arrival_queues.hpp"
#include "protocols/bandwidth/window_traffic.hpp"

// What real-time and non-real-time queues offer, as each Load has it.
namespace fieldproof::bandwidth {

// What those who work against the data of a slot know of it: how far it has gone, and where its worst begin
// would be.
class SlotView {
 public:
  // The traffic must outlive it.
  explicit SlotView(const WindowTraffic& traffic);

  void advance(kernel::Time now) {
    while (now >= end_) next_slot();
  }
  void on_sent_periodic() {
    if (left_ > 0) --left_;
  }

  std::uint64_t slot() const { return slot_; }
  kernel::Time end() const { return end_; }
  // Data of this slot that have not been sent.
  unsigned left() const { return left_; }
  // The node from where the last datum of the next slot waits longest, when a packet has just begun there.
  std::uint8_t worst_of_next() const;

 private:
  void next_slot();

  const WindowTraffic& traffic_;
  std::vector<unsigned> loads_;
  mutable std::vector<int> worst_;  // nodes; -1: nobody has asked yet
  std::uint64_t slot_ = 0;
  kernel::Time end_;
  unsigned left_;
};

// The queues of one kind.
class QueueSet {
 public:
  QueueSet(const WindowTraffic& traffic, const std::vector<QueueTraffic>& queues, Load load,
           kernel::Duration packet, const kernel::Random& random);

  bool is_at(std::uint8_t node) const { return place_[node] >= 0; }
  // Is there a packet at the node?
  bool offers(std::uint8_t node, kernel::Time now, const SlotView& slot);
  void on_sent(std::uint8_t node, kernel::Time end);
  void begin_counting(kernel::Time now);
  QueueFigures figures(kernel::Time now, bool tells_growth);

 private:
  bool has_arrived(std::uint8_t node, kernel::Time now);
  bool is_drawn(std::uint8_t node, const SlotView& slot);
  bool is_just_late(std::uint8_t node, kernel::Time now, const SlotView& slot);
  void aim(std::uint8_t node, kernel::Time now, const SlotView& slot);

  Load load_;
  kernel::Duration packet_;
  kernel::Duration step_;  // of a visit without a packet
  kernel::Duration step_of_packet_;
  unsigned nodes_;
  std::vector<int> place_;  // of the queue, by node; -1: none
  std::vector<traffic::TimedQueue> timed_;
  std::vector<kernel::Time> free_from_;  // by queue: the last packet was sent
  QueueFigures figures_;
  kernel::Time counted_from_ = kernel::kStart;
  std::uint64_t waiting_before_ = 0;
  kernel::Random random_;
  // Of the slot for which the next was drawn.
  std::uint64_t drawn_for_ = ~std::uint64_t{0};
  double probability_ = 0;
  // Packets that bring the server to the node in time.
  std::uint64_t aimed_for_ = ~std::uint64_t{0};
  unsigned fillers_ = 0;
};

}  // namespace fieldproof::bandwidth
