// Independent pieces of work over several threads, with results handed over in their order.
//
// Contract: `work(i)` runs once for every i that was started, on any thread, several at a time; `deliver(i,
// result)` runs on the calling thread, for 0, 1, 2 ... without a gap, whatever the number of threads, so
// everything built from the deliveries is the same for one thread and for many. When `deliver` answers false
// nothing more is delivered. When the stop token is set no further piece is started; those that were started
// are finished and delivered up to the first one that was not started. An exception of `work` is thrown again
// in its turn, on the calling thread. `idle` is called on the calling thread a few times a second and after
// each finished piece with the number of finished pieces; with one thread only between the pieces.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

namespace fieldproof::conformance {

template <typename Result>
class OrderedWork {
 public:
  std::size_t count = 0;
  unsigned threads = 1;
  std::stop_token stop;
  std::function<Result(std::size_t)> work;
  std::function<bool(std::size_t, Result&&)> deliver;
  std::function<void(std::size_t)> idle;

  // The number of delivered results.
  std::size_t run() { return threads <= 1 || count <= 1 ? run_here() : run_over_threads(); }

 private:
  struct Slot {
    std::optional<Result> result;
    std::exception_ptr failure;
    bool is_finished() const { return result.has_value() || failure != nullptr; }
  };

  std::size_t run_here() {
    for (std::size_t i = 0; i < count; ++i) {
      if (stop.stop_requested()) return i;
      Result result = work(i);
      if (idle) idle(i + 1);
      if (!deliver(i, std::move(result))) return i + 1;
    }
    return count;
  }

  std::size_t run_over_threads() {
    slots_.resize(count);
    const std::size_t pool = std::min<std::size_t>(threads, count);
    std::vector<std::jthread> workers;
    running_ = pool;
    for (std::size_t i = 0; i < pool; ++i) workers.emplace_back([this] { take_work(); });
    // A deliver that throws must not leave workers after that start further pieces.
    struct Closing {
      OrderedWork* owner;
      ~Closing() { owner->close(); }
    } closing{this};
    return hand_over();
  }

  void close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
  }

  void take_work() {
    std::unique_lock lock(mutex_);
    while (!is_closed_ && !stop.stop_requested() && next_ < count) {
      const std::size_t mine = next_++;
      lock.unlock();
      Slot slot;
      try {
        slot.result.emplace(work(mine));
      } catch (...) {
        slot.failure = std::current_exception();
      }
      lock.lock();
      slots_[mine] = std::move(slot);
      ++finished_;
      changed_.notify_one();
    }
    --running_;
    changed_.notify_one();
  }

  std::size_t hand_over() {
    std::size_t delivered = 0;
    std::unique_lock lock(mutex_);
    while (true) {
      while (delivered < count && slots_[delivered].is_finished()) {
        Slot slot = std::exchange(slots_[delivered], Slot{});
        lock.unlock();
        if (slot.failure) std::rethrow_exception(slot.failure);
        if (!deliver(delivered++, std::move(*slot.result))) return delivered;
        lock.lock();
      }
      if (delivered == count || (running_ == 0 && !slots_[delivered].is_finished())) return delivered;
      const std::size_t before = finished_;
      changed_.wait_for(lock, std::chrono::milliseconds(100),
                        [&] { return finished_ != before || running_ == 0; });
      if (idle) report_idle(lock);
    }
  }

  void report_idle(std::unique_lock<std::mutex>& lock) {
    const std::size_t finished = finished_;
    lock.unlock();
    idle(finished);
    lock.lock();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Slot> slots_;
  std::size_t next_ = 0;
  std::size_t finished_ = 0;
  std::size_t running_ = 0;
  bool is_closed_ = false;
};

}  // namespace fieldproof::conformance
