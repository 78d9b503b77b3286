#include "harness/kernel/scheduler.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "harness/kernel/random.hpp"

namespace fieldproof::kernel {
namespace {

Time at(std::int64_t picoseconds) {
  return Time{Duration{picoseconds}};
}

// Writes down who fired when, and then does what it was told.
struct Recorder : Timer {
  using Log = std::vector<std::pair<int, Time>>;

  Recorder(Log& log, int name) : log_(log), name_(name) {}
  void on_time(Time now) override {
    log_.emplace_back(name_, now);
    if (then) then(now);
  }

  std::function<void(Time)> then;

 private:
  Log& log_;
  int name_;
};

struct SchedulerTest : testing::Test {
  Recorder::Log log;
  Scheduler scheduler;
  Recorder a{log, 0};
  Recorder b{log, 1};
  Recorder c{log, 2};
  SlotId slot_a = scheduler.add(a);
  SlotId slot_b = scheduler.add(b);
  SlotId slot_c = scheduler.add(c);
};

TEST_F(SchedulerTest, IsIdleAtFirst) {
  EXPECT_EQ(scheduler.next(), kNever);
  EXPECT_EQ(scheduler.armed(slot_a), kNever);
  EXPECT_FALSE(scheduler.step());
  scheduler.run_until(at(5));
  EXPECT_EQ(scheduler.now(), at(5));
  EXPECT_TRUE(log.empty());
}

TEST_F(SchedulerTest, FiresInTheOrderOfTimes) {
  scheduler.arm(slot_a, at(30));
  scheduler.arm(slot_b, at(10));
  scheduler.arm(slot_c, at(20));
  EXPECT_EQ(scheduler.next(), at(10));
  scheduler.run();
  EXPECT_EQ(log, (Recorder::Log{{1, at(10)}, {2, at(20)}, {0, at(30)}}));
  EXPECT_EQ(scheduler.now(), at(30));
}

TEST_F(SchedulerTest, TiesFireInTheOrderOfArmingAndRearmingCountsAnew) {
  scheduler.arm(slot_c, at(10));
  scheduler.arm(slot_a, at(10));
  scheduler.arm(slot_b, at(10));
  scheduler.arm(slot_c, at(10));
  scheduler.run();
  EXPECT_EQ(log, (Recorder::Log{{0, at(10)}, {1, at(10)}, {2, at(10)}}));
}

TEST_F(SchedulerTest, TimesBeforeZeroComeFirst) {
  Scheduler early(at(-100));
  const SlotId first = early.add(a);
  const SlotId second = early.add(b);
  early.arm(first, at(1));
  early.arm(second, at(-1));
  early.run();
  EXPECT_EQ(log, (Recorder::Log{{1, at(-1)}, {0, at(1)}}));
}

TEST_F(SchedulerTest, RunUntilIncludesItsEnd) {
  scheduler.arm(slot_a, at(10));
  scheduler.arm(slot_b, at(11));
  scheduler.run_until(at(10));
  EXPECT_EQ(log.size(), 1U);
  EXPECT_EQ(scheduler.now(), at(10));
  scheduler.run_until(at(10));
  EXPECT_EQ(log.size(), 1U);
}

TEST_F(SchedulerTest, CancelAndArmingForNeverAreTheSame) {
  scheduler.arm(slot_a, at(10));
  scheduler.arm(slot_b, at(10));
  scheduler.cancel(slot_a);
  scheduler.arm(slot_b, kNever);
  EXPECT_EQ(scheduler.armed(slot_a), kNever);
  EXPECT_EQ(scheduler.armed(slot_b), kNever);
  EXPECT_FALSE(scheduler.step());
}

TEST_F(SchedulerTest, AHandlerSeesItselfDisarmedAndMayRearm) {
  a.then = [&](Time now) {
    EXPECT_EQ(scheduler.now(), now);
    EXPECT_EQ(scheduler.armed(slot_a), kNever);
    EXPECT_EQ(scheduler.next(), at(40));
    if (now == at(30)) return;
    scheduler.arm(slot_a, now + Duration{10});
    EXPECT_EQ(scheduler.next(), now + Duration{10});
  };
  scheduler.arm(slot_b, at(40));
  scheduler.arm(slot_a, at(10));
  scheduler.run();
  EXPECT_EQ(log, (Recorder::Log{{0, at(10)}, {0, at(20)}, {0, at(30)}, {1, at(40)}}));
}

TEST_F(SchedulerTest, WhatIsArmedForNowInAHandlerFiresAfterWhatWasArmedBefore) {
  a.then = [&](Time now) { scheduler.arm(slot_c, now); };
  scheduler.arm(slot_a, at(10));
  scheduler.arm(slot_b, at(10));
  scheduler.run();
  EXPECT_EQ(log, (Recorder::Log{{0, at(10)}, {1, at(10)}, {2, at(10)}}));
}

TEST_F(SchedulerTest, AHandlerMayCancelAndArmOthersBeforeItIsSettled) {
  a.then = [&](Time now) {
    scheduler.cancel(slot_b);
    scheduler.arm(slot_c, now + Duration{1});
    EXPECT_EQ(scheduler.next(), now + Duration{1});
  };
  scheduler.arm(slot_a, at(10));
  scheduler.arm(slot_b, at(10));
  scheduler.run();
  EXPECT_EQ(log, (Recorder::Log{{0, at(10)}, {2, at(11)}}));
}

TEST_F(SchedulerTest, AHandlerMayRemoveItselfAndAddOthers) {
  std::vector<std::unique_ptr<Recorder>> added;
  a.then = [&](Time now) {
    scheduler.remove(slot_a);
    for (int k = 0; k < 20; ++k) {
      added.push_back(std::make_unique<Recorder>(log, 10 + k));
      scheduler.arm(scheduler.add(*added.back()), now + Duration{20 - k});
    }
  };
  scheduler.arm(slot_a, at(10));
  scheduler.arm(slot_b, at(15));
  scheduler.run();
  ASSERT_EQ(log.size(), 22U);
  EXPECT_EQ(log[1], std::make_pair(29, at(11)));
  EXPECT_EQ(log[5], std::make_pair(1, at(15)));  // armed before the one that ties with it
  EXPECT_EQ(log[21], std::make_pair(10, at(30)));
}

TEST_F(SchedulerTest, AHandlerMayStepTheSchedulerItself) {
  a.then = [&](Time) { scheduler.run_until(at(20)); };
  scheduler.arm(slot_a, at(10));
  scheduler.arm(slot_b, at(15));
  scheduler.arm(slot_c, at(25));
  scheduler.run();
  EXPECT_EQ(log, (Recorder::Log{{0, at(10)}, {1, at(15)}, {2, at(25)}}));
}

TEST_F(SchedulerTest, AnExceptionFromAHandlerLeavesItsTimerDisarmed) {
  a.then = [](Time) { throw 7; };
  scheduler.arm(slot_a, at(10));
  scheduler.arm(slot_b, at(20));
  EXPECT_THROW(scheduler.step(), int);
  EXPECT_EQ(scheduler.armed(slot_a), kNever);
  EXPECT_EQ(scheduler.next(), at(20));
  scheduler.run();
  EXPECT_EQ(log, (Recorder::Log{{0, at(10)}, {1, at(20)}}));
}

TEST_F(SchedulerTest, RefusesBrokenPromises) {
  scheduler.run_until(at(10));
  EXPECT_THROW(scheduler.arm(slot_a, at(9)), BrokenInvariant);
  EXPECT_THROW(scheduler.run_until(at(9)), BrokenInvariant);
  EXPECT_THROW(scheduler.run_until(kNever), BrokenInvariant);
  scheduler.remove(slot_a);
  EXPECT_THROW(scheduler.arm(slot_a, at(11)), BrokenInvariant);
  EXPECT_THROW(scheduler.cancel(slot_a), BrokenInvariant);
  EXPECT_THROW(scheduler.remove(slot_a), BrokenInvariant);
  EXPECT_THROW(scheduler.armed(SlotId{99}), BrokenInvariant);
}

TEST_F(SchedulerTest, ASlotIsUsedAgainAfterRemovalAndNotArmed) {
  scheduler.arm(slot_b, at(10));
  scheduler.remove(slot_b);
  EXPECT_EQ(scheduler.add(c), slot_b);
  EXPECT_EQ(scheduler.armed(slot_b), kNever);
  EXPECT_FALSE(scheduler.step());
}

// The contract in its simplest form: keys (time, count of armings) in an ordered map.
class Model {
 public:
  explicit Model(std::size_t slots) : armed_(slots) {}

  void arm(std::size_t slot, Time when) {
    cancel(slot);
    armed_[slot] = queue_.emplace(std::make_pair(when, count_++), slot).first;
  }
  void cancel(std::size_t slot) {
    if (armed_[slot]) queue_.erase(*armed_[slot]);
    armed_[slot].reset();
  }
  Time armed(std::size_t slot) const { return armed_[slot] ? (*armed_[slot])->first.first : kNever; }
  Time next() const { return queue_.empty() ? kNever : queue_.begin()->first.first; }
  std::size_t pop() {
    const std::size_t slot = queue_.begin()->second;
    cancel(slot);
    return slot;
  }

 private:
  using Queue = std::map<std::pair<Time, std::uint64_t>, std::size_t>;
  Queue queue_;
  std::vector<std::optional<Queue::iterator>> armed_;
  std::uint64_t count_ = 0;
};

// Both driven by the same decisions; every answer is compared, also those given inside handlers. Short times
// make ties frequent.
class Pair {
 public:
  Pair(std::size_t slots, std::uint64_t seed) : model_(slots), random_(seed) {
    for (std::size_t k = 0; k < slots; ++k) {
      timers_.push_back(std::make_unique<Handler>(*this, k));
      slots_.push_back(scheduler_.add(*timers_.back()));
    }
  }

  void act() {
    const auto slot = static_cast<std::size_t>(random_.below(slots_.size()));
    const auto action = random_.below(10);
    if (action < 6) {
      const Time when = scheduler_.now() + Duration{random_.between(0, 8)};
      scheduler_.arm(slots_[slot], when);
      model_.arm(slot, when);
    } else if (action < 8) {
      scheduler_.cancel(slots_[slot]);
      model_.cancel(slot);
    } else if (action < 9) {
      scheduler_.remove(slots_[slot]);
      model_.cancel(slot);
      slots_[slot] = scheduler_.add(*timers_[slot]);
    }
    compare(slot);
  }

  bool step() {
    const Time due = model_.next();
    expected_ = due == kNever ? kNone : model_.pop();
    const bool fired = scheduler_.step();
    RC_ASSERT(fired == (due != kNever));
    RC_ASSERT(expected_ == kNone);
    RC_ASSERT(!fired || scheduler_.now() == due);
    return fired;
  }

  std::uint64_t below(std::uint64_t bound) { return random_.below(bound); }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  struct Handler : Timer {
    Handler(Pair& pair, std::size_t index) : pair_(pair), index_(index) {}
    void on_time(Time now) override { pair_.on_fired(index_, now); }
    Pair& pair_;
    std::size_t index_;
  };

  void on_fired(std::size_t index, Time now) {
    RC_ASSERT(index == std::exchange(expected_, kNone));
    RC_ASSERT(now == scheduler_.now());
    compare(index);
    for (auto actions = random_.below(4); actions > 0; --actions) act();
  }

  void compare(std::size_t slot) {
    RC_ASSERT(scheduler_.armed(slots_[slot]) == model_.armed(slot));
    RC_ASSERT(scheduler_.next() == model_.next());
  }

  Scheduler scheduler_;
  Model model_;
  Random random_;
  std::vector<std::unique_ptr<Handler>> timers_;
  std::vector<SlotId> slots_;
  std::size_t expected_ = kNone;
};

RC_GTEST_PROP(Scheduler, DoesWhatAnOrderedMapDoes, (std::uint64_t seed)) {
  Pair pair(*rc::gen::inRange<std::size_t>(1, 70), seed);
  for (int k = 0; k < 300; ++k) {
    if (pair.below(3) == 0) {
      pair.step();
    } else {
      pair.act();
    }
  }
  for (int k = 0; k < 300 && pair.step(); ++k) {
  }
}

// The order of events is the same wherever timers lie in memory.
TEST(Scheduler, OrderDoesNotDependOnAddresses) {
  const auto run = [](bool reversed) {
    Recorder::Log log;
    Scheduler scheduler;
    std::vector<std::unique_ptr<Recorder>> timers(100);
    for (int k = 0; k < 100; ++k) {
      const int index = reversed ? 99 - k : k;
      timers[static_cast<std::size_t>(index)] = std::make_unique<Recorder>(log, index);
    }
    Random random(3);
    for (const auto& timer : timers) {
      const SlotId slot = scheduler.add(*timer);
      timer->then = [&scheduler, &random, slot](Time now) {
        scheduler.arm(slot, now + Duration{random.between(1, 5)});
      };
      scheduler.arm(slot, at(random.between(0, 5)));
    }
    scheduler.run_until(at(500));
    return log;
  };
  const Recorder::Log log = run(false);
  EXPECT_GT(log.size(), 10'000U);
  EXPECT_EQ(log, run(true));
}

}  // namespace
}  // namespace fieldproof::kernel
