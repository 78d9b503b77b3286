#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <utility>

#include "protocols/fieldbus_dll/link_rules.hpp"

// What waits to be sent, one queue for each priority.
namespace fieldproof::fieldbus_dll {

template <typename Request>
class RequestQueues {
 public:
  static constexpr std::array kMostUrgentFirst{Priority::urgent, Priority::normal, Priority::time_available};

  void push(const Request& request) { queue(request.priority).push_back(request); }
  std::deque<Request>& queue(Priority priority) { return queues_[static_cast<std::size_t>(priority) - 1]; }
  const std::deque<Request>& queue(Priority priority) const {
    return queues_[static_cast<std::size_t>(priority) - 1];
  }
  bool empty() const {
    for (const auto& one : queues_) {
      if (!one.empty()) return false;
    }
    return true;
  }
  Request pop(Priority priority) {
    Request request = std::move(queue(priority).front());
    queue(priority).pop_front();
    return request;
  }

 private:
  std::array<std::deque<Request>, 3> queues_;
};

}  // namespace fieldproof::fieldbus_dll
