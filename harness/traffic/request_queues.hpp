#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <utility>

#include "harness/kernel/check.hpp"

// What waits to be sent, one queue for each priority. A `Request` has a `priority`.
namespace fieldproof::traffic {

template <typename Request, auto... kPriorities>
class RequestQueues {
 public:
  static constexpr std::array kMostUrgentFirst{kPriorities...};
  using Priority = decltype(kMostUrgentFirst)::value_type;

  void push(const Request& request) { queue(request.priority).push_back(request); }
  std::deque<Request>& queue(Priority priority) { return queues_[place_of(priority)]; }
  const std::deque<Request>& queue(Priority priority) const { return queues_[place_of(priority)]; }
  bool empty() const {
    for (const auto& one : queues_) {
      if (!one.empty()) return false;
    }
    return true;
  }
  Request pop(Priority priority) {
    FIELDPROOF_CHECK(!queue(priority).empty(), "what is taken from a queue is in it");
    Request request = std::move(queue(priority).front());
    queue(priority).pop_front();
    return request;
  }

 private:
  static std::size_t place_of(Priority priority) {
    std::size_t place = 0;
    while (kMostUrgentFirst.at(place) != priority) ++place;
    return place;
  }

  std::array<std::deque<Request>, sizeof...(kPriorities)> queues_;
};

}  // namespace fieldproof::traffic
