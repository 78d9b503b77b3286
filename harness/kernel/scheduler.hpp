// The scheduler of virtual time: a fixed set of timers, each armed for one instant or for none.
//
// Contract: `step` moves now() to the earliest armed instant, disarms that timer and calls it. Timers armed
// for the same instant fire in the order in which they were armed; re-arming counts as arming anew. Inside
// `on_time` everything may be called, also add and remove; the fired slot is already disarmed there. Arming
// before now() is a broken invariant; arming at now() fires within this instant, after all that was armed for
// it before. Arming for kNever is the same as cancelling. Nothing depends on addresses or on the machine.
//
// How: a winner tree. Leaf i holds the key of slot i, each inner node the smaller key of its two children,
// the root the next to fire. A key is (time, order), order = sequence number and slot in one word, so that
// one 128-bit comparison decides also ties and the winner names its slot. Changing a key walks one path of
// log2(slots) nodes without an unpredictable branch. A fired slot keeps its stale key until its handler has
// either re-armed it or returned: the common case, a timer that re-arms itself, then walks once and not
// twice.
//
// Limits: 2^20 slots; 2^44 armings in the life of one scheduler (both checked).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "harness/kernel/check.hpp"
#include "harness/kernel/time.hpp"

namespace fieldproof::kernel {

// What the scheduler calls. It must outlive its slot.
struct Timer {
  virtual ~Timer() = default;
  virtual void on_time(Time now) = 0;
};

// Names a slot of one scheduler, from add() to remove(). Numbers are dense and are used again.
enum class SlotId : std::uint32_t {};

class Scheduler {
 public:
  explicit Scheduler(Time start = kStart);
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  Time now() const { return now_; }

  // A new slot, not armed.
  SlotId add(Timer& timer);

  // Gives the slot back; an armed one is cancelled.
  void remove(SlotId slot);

  void arm(SlotId slot, Time at);
  void cancel(SlotId slot);

  // The instant for which the slot is armed, kNever when it is not.
  Time armed(SlotId slot) const;

  // The earliest armed instant, kNever when nothing is armed.
  Time next() const;

  // Fires the next timer; false when nothing is armed.
  bool step();

  // Fires everything up to and including `end`; afterwards now() == end. `end` is not before now() and is not
  // kNever.
  void run_until(Time end);

  // Fires until nothing is armed; now() stays at the last instant.
  void run() {
    while (step()) {
    }
  }

 private:
  struct Key {
    std::int64_t time;
    std::uint64_t order;
  };

  static constexpr unsigned kSlotBits = 20;
  static constexpr std::uint64_t kSlotMask = (std::uint64_t{1} << kSlotBits) - 1;
  static constexpr std::size_t kNoSlot = ~std::size_t{0};
  static constexpr Key kIdle{kNever.time_since_epoch().count(), ~std::uint64_t{0}};

  static Key earlier(Key a, Key b);
  void set_key(std::size_t slot, Key key);
  void settle();
  Time next_without_fired() const;
  void fire();
  void grow();
  void check_slot(SlotId slot) const;

  // nodes_[1] is the root, nodes_[k] has the children 2k and 2k + 1, slot i is nodes_[capacity_ + i].
  std::vector<Key> nodes_;
  std::size_t capacity_;
  std::vector<Timer*> timers_;           // by slot, null when free
  std::vector<std::size_t> free_slots_;  // the last one is used first
  std::uint64_t next_order_ = 0;         // sequence number, shifted above the slot
  std::size_t fired_ = kNoSlot;          // its leaf still holds the key that fired
  Time now_;
};

inline Scheduler::Key Scheduler::earlier(Key a, Key b) {
  // Which child wins is a coin toss that no predictor learns, so it must not become a jump; compilers make
  // one of every form in C++, depending on version and level. Hence the four instructions by hand where we
  // can: a 128-bit comparison by subtraction with borrow, and two conditional moves.
#if defined(__x86_64__)
  std::int64_t difference = a.time;
  __asm__(
      "cmp %[order_b], %[order_a]\n\t"
      "sbb %[time_b], %[difference]\n\t"
      "cmovge %[time_b], %[time_a]\n\t"
      "cmovge %[order_b], %[order_a]"
      : [time_a] "+&r"(a.time), [order_a] "+&r"(a.order), [difference] "+&r"(difference)
      : [time_b] "r"(b.time), [order_b] "r"(b.order)
      : "cc");
  return a;
#else
  const bool a_wins = a.time != b.time ? a.time < b.time : a.order < b.order;
  return a_wins ? a : b;
#endif
}

inline void Scheduler::set_key(std::size_t slot, Key key) {
  Key* const nodes = nodes_.data();
  std::size_t node = capacity_ + slot;
  nodes[node] = key;
  while (node > 1) {
    key = earlier(key, nodes[node ^ 1]);
    node >>= 1;
    nodes[node] = key;
  }
}

inline void Scheduler::check_slot(SlotId slot) const {
  const auto index = static_cast<std::size_t>(slot);
  FIELDPROOF_CHECK(index < timers_.size() && timers_[index] != nullptr,
                   "a scheduler slot is used after its removal or with another scheduler");
}

inline void Scheduler::arm(SlotId slot, Time at) {
  check_slot(slot);
  FIELDPROOF_CHECK(at >= now_, "a timer is armed for an instant that has passed");
  const auto index = static_cast<std::size_t>(slot);
  const std::uint64_t order = next_order_;
  next_order_ += kSlotMask + 1;
  FIELDPROOF_CHECK(next_order_ != 0, "the sequence numbers of a scheduler are used up");
  if (fired_ == index) fired_ = kNoSlot;
  set_key(index, {at.time_since_epoch().count(), order | index});
}

inline void Scheduler::cancel(SlotId slot) {
  check_slot(slot);
  const auto index = static_cast<std::size_t>(slot);
  if (fired_ == index) fired_ = kNoSlot;
  set_key(index, kIdle);
}

inline Time Scheduler::armed(SlotId slot) const {
  check_slot(slot);
  const auto index = static_cast<std::size_t>(slot);
  return fired_ == index ? kNever : Time{Duration{nodes_[capacity_ + index].time}};
}

inline Time Scheduler::next() const {
  return fired_ == kNoSlot ? Time{Duration{nodes_[1].time}} : next_without_fired();
}

inline void Scheduler::settle() {
  if (fired_ != kNoSlot) {
    set_key(fired_, kIdle);
    fired_ = kNoSlot;
  }
}

inline void Scheduler::fire() {
  const Key first = nodes_[1];
  fired_ = static_cast<std::size_t>(first.order & kSlotMask);
  now_ = Time{Duration{first.time}};
  timers_[fired_]->on_time(now_);
  settle();
}

inline bool Scheduler::step() {
  // A handler that left by an exception, or one that steps the scheduler itself, has not settled.
  settle();
  if (nodes_[1].time == kIdle.time) return false;
  fire();
  return true;
}

inline void Scheduler::run_until(Time end) {
  FIELDPROOF_CHECK(end >= now_ && end != kNever,
                   "a scheduler is run to an instant that has passed or to never");
  settle();
  const std::int64_t last = end.time_since_epoch().count();
  while (nodes_[1].time <= last) fire();
  now_ = end;
}

}  // namespace fieldproof::kernel
