// The hold model of event queues beside ns-3 and a standard priority queue: N timers are pending, each that
// fires is armed again. All rows take the same increments from one table, so all fire in the same order; that
// is checked when a row is set up. About one event in five ties with another. In the model with cancellation
// every eighth event also cancels another timer and arms it anew.
//
// Each row uses its queue as its users do: ns-3 with an event object per arming, cancelled by its flag;
// std::priority_queue with std::function and a number that tells stale entries; ours with fixed timers.
#include <array>
#include <functional>
#include <memory>
#include <queue>
#include <stdexcept>
#include <vector>

#include "bench/rows.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/scheduler.hpp"

#ifdef FIELDPROOF_HAVE_NS3
#include <ns3/calendar-scheduler.h>
#include <ns3/event-impl.h>
#include <ns3/heap-scheduler.h>
#include <ns3/make-event.h>
#include <ns3/map-scheduler.h>
#include <ns3/object-factory.h>
#include <ns3/priority-queue-scheduler.h>
#endif

namespace fieldproof::bench {
namespace {

using kernel::Duration;
using kernel::Random;
using kernel::Time;

struct Workload {
  std::uint32_t pending;
  bool cancels;
};

// What happens when a timer fires; the same for all queues. A Queue has arm(node, instant), cancel(node) and
// step(), which calls on_fired(node, now) of the model.
template <typename Queue>
class HoldModel {
 public:
  explicit HoldModel(Workload workload) : workload_(workload), queue_(*this, workload.pending) {
    Random random(workload.pending);
    for (std::uint32_t& increment : increments_) {
      increment = static_cast<std::uint32_t>(1 + random.below(8 * std::uint64_t{workload.pending}));
    }
    for (std::uint32_t& victim : victims_)
      victim = static_cast<std::uint32_t>(random.below(workload.pending));
    for (std::uint32_t node = 0; node < workload.pending; ++node) queue_.arm(node, next_increment());
  }

  void on_fired(std::uint32_t node, std::int64_t now) {
    ++fired_;
    fingerprint_ = fingerprint_ * 31 + node;
    queue_.arm(node, now + next_increment());
    if (workload_.cancels && (fired_ & 7) == 0) {
      const std::uint32_t victim = victims_[fired_ % kDraws];
      queue_.cancel(victim);
      queue_.arm(victim, now + next_increment());
    }
  }

  std::uint64_t run(std::uint64_t events) {
    for (const std::uint64_t end = fired_ + events; fired_ < end;) queue_.step();
    return events;
  }

  std::uint64_t fingerprint() const { return fingerprint_; }

 private:
  static constexpr std::size_t kDraws = 1 << 14;

  std::int64_t next_increment() { return increments_[drawn_++ % kDraws]; }

  Workload workload_;
  std::array<std::uint32_t, kDraws> increments_{};
  std::array<std::uint32_t, kDraws> victims_{};
  std::uint64_t drawn_ = 0;
  std::uint64_t fired_ = 0;
  std::uint64_t fingerprint_ = 0;
  Queue queue_;
};

class OurQueue {
 public:
  OurQueue(HoldModel<OurQueue>& model, std::uint32_t pending) {
    timers_.reserve(pending);
    for (std::uint32_t node = 0; node < pending; ++node) {
      timers_.emplace_back(model, node);
      slots_.push_back(scheduler_.add(timers_.back()));
    }
  }
  void arm(std::uint32_t node, std::int64_t at) { scheduler_.arm(slots_[node], Time{Duration{at}}); }
  void cancel(std::uint32_t node) { scheduler_.cancel(slots_[node]); }
  void step() { scheduler_.step(); }

 private:
  struct Node final : kernel::Timer {
    Node(HoldModel<OurQueue>& its_model, std::uint32_t its_number) : model(&its_model), number(its_number) {}
    void on_time(Time now) override { model->on_fired(number, now.time_since_epoch().count()); }
    HoldModel<OurQueue>* model;
    std::uint32_t number;
  };

  kernel::Scheduler scheduler_;
  std::vector<Node> timers_;
  std::vector<kernel::SlotId> slots_;
};

class StandardQueue {
 public:
  StandardQueue(HoldModel<StandardQueue>& model, std::uint32_t pending) : model_(model), current_(pending) {}
  void arm(std::uint32_t node, std::int64_t at) {
    const std::uint64_t number = ++armed_;
    current_[node] = number;
    events_.push({at, number, [this, node, number](std::int64_t now) {
                    if (current_[node] == number) model_.on_fired(node, now);
                  }});
  }
  void cancel(std::uint32_t node) { current_[node] = 0; }
  void step() {
    // top() is const; the entry is popped right after, so nobody sees it moved from.
    Event event = std::move(const_cast<Event&>(events_.top()));
    events_.pop();
    event.act(event.time);
  }

 private:
  struct Event {
    std::int64_t time;
    std::uint64_t number;
    std::function<void(std::int64_t)> act;
    bool operator<(const Event& other) const {
      return time != other.time ? time > other.time : number > other.number;
    }
  };

  HoldModel<StandardQueue>& model_;
  std::vector<std::uint64_t> current_;
  std::priority_queue<Event> events_;
  std::uint64_t armed_ = 0;
};

#ifdef FIELDPROOF_HAVE_NS3
// ns-3's queues as its simulator drives them, without the rest of the simulator.
template <typename Queue>
class Ns3Queue {
 public:
  Ns3Queue(HoldModel<Ns3Queue>& model, std::uint32_t pending)
      : model_(model), queue_(ns3::CreateObject<Queue>()), current_(pending) {}
  ~Ns3Queue() {
    while (!queue_->IsEmpty()) queue_->RemoveNext().impl->Unref();
  }
  Ns3Queue(const Ns3Queue&) = delete;
  Ns3Queue& operator=(const Ns3Queue&) = delete;

  void arm(std::uint32_t node, std::int64_t at) {
    ns3::EventImpl* const event = ns3::MakeEvent(&Ns3Queue::on_event, this, node);
    current_[node] = event;
    queue_->Insert({event, {static_cast<std::uint64_t>(at), ++armed_, 0}});
  }
  void cancel(std::uint32_t node) { current_[node]->Cancel(); }
  void step() {
    const ns3::Scheduler::Event event = queue_->RemoveNext();
    now_ = static_cast<std::int64_t>(event.key.m_ts);
    event.impl->Invoke();
    event.impl->Unref();
  }

 private:
  void on_event(std::uint32_t node) { model_.on_fired(node, now_); }

  HoldModel<Ns3Queue>& model_;
  ns3::Ptr<ns3::Scheduler> queue_;
  std::vector<ns3::EventImpl*> current_;
  std::uint32_t armed_ = 0;
  std::int64_t now_ = 0;
};
#endif

template <typename Queue>
Row row_of(const std::string& group, const std::string& name, Workload workload, double target) {
  constexpr std::uint64_t kEvents = 20'000;
  return {group, name, "events", target > 0 ? "ns-3" : "", target, [workload, name] {
            auto model = std::make_shared<HoldModel<Queue>>(workload);
            HoldModel<OurQueue> reference(workload);
            model->run(kEvents);
            reference.run(kEvents);
            if (model->fingerprint() != reference.fingerprint()) {
              throw std::logic_error(name + " fires in another order than the others");
            }
            return [model] { return model->run(kEvents); };
          }};
}

std::vector<Row> rows_of(Workload workload) {
  const std::string group = "scheduler " +
                            std::string(workload.cancels ? "with cancellation, " : "hold model, ") +
                            std::to_string(workload.pending) + " pending";
  std::vector<Row> rows;
#ifdef FIELDPROOF_HAVE_NS3
  rows.push_back(row_of<Ns3Queue<ns3::MapScheduler>>(group, "ns-3 map (its default)", workload, 0));
  rows.push_back(row_of<Ns3Queue<ns3::HeapScheduler>>(group, "ns-3 heap", workload, 0));
  rows.push_back(row_of<Ns3Queue<ns3::PriorityQueueScheduler>>(group, "ns-3 priority queue", workload, 0));
  rows.push_back(row_of<Ns3Queue<ns3::CalendarScheduler>>(group, "ns-3 calendar", workload, 0));
#endif
  rows.push_back(row_of<StandardQueue>(group, "std::priority_queue of std::function", workload, 0));
  // Asked for is four times at 16 pending; the deeper ones guard what was reached.
  rows.push_back(row_of<OurQueue>(group, "fieldproof", workload, workload.pending <= 256 ? 4 : 3));
  return rows;
}

const Rows kHold16(rows_of({16, false}));
const Rows kHold256(rows_of({256, false}));
const Rows kHold4096(rows_of({4096, false}));
const Rows kCancel16(rows_of({16, true}));
const Rows kCancel256(rows_of({256, true}));
const Rows kCancel4096(rows_of({4096, true}));

}  // namespace
}  // namespace fieldproof::bench
