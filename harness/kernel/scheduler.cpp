#include "harness/kernel/scheduler.hpp"

#include <utility>

namespace fieldproof::kernel {

namespace {
constexpr std::size_t kSmallestCapacity = 4;
}

Scheduler::Scheduler(Time start)
    : nodes_(2 * kSmallestCapacity, kIdle), capacity_(kSmallestCapacity), now_(start) {}

SlotId Scheduler::add(Timer& timer) {
  if (!free_slots_.empty()) {
    const std::size_t slot = free_slots_.back();
    free_slots_.pop_back();
    timers_[slot] = &timer;
    return SlotId{static_cast<std::uint32_t>(slot)};
  }
  if (timers_.size() == capacity_) grow();
  timers_.push_back(&timer);
  return SlotId{static_cast<std::uint32_t>(timers_.size() - 1)};
}

void Scheduler::remove(SlotId slot) {
  cancel(slot);
  const auto index = static_cast<std::size_t>(slot);
  timers_[index] = nullptr;
  free_slots_.push_back(index);
}

// The earliest key when the stale one of the fired slot is left out: walks its path without writing.
Time Scheduler::next_without_fired() const {
  Key key = kIdle;
  for (std::size_t node = capacity_ + fired_; node > 1; node >>= 1) key = earlier(key, nodes_[node ^ 1]);
  return Time{Duration{key.time}};
}

void Scheduler::grow() {
  FIELDPROOF_CHECK(capacity_ <= (kSlotMask + 1) / 2, "a scheduler has more than 2^20 slots");
  std::vector<Key> wider(4 * capacity_, kIdle);
  const std::size_t new_capacity = 2 * capacity_;
  for (std::size_t slot = 0; slot < capacity_; ++slot) wider[new_capacity + slot] = nodes_[capacity_ + slot];
  for (std::size_t node = new_capacity - 1; node >= 1; --node) {
    wider[node] = earlier(wider[2 * node], wider[2 * node + 1]);
  }
  nodes_ = std::move(wider);
  capacity_ = new_capacity;
}

}  // namespace fieldproof::kernel
