#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>

// For mutants that send in the order of submission, whatever the priorities.
namespace fieldproof::conformance {

template <typename Queues>
class SubmissionOrder {
 public:
  using Priority = typename Queues::Priority;

  void add(Priority priority) { priorities_.push_back(priority); }

  // Of what is in the queues still: what was sent, or lost with the supply, is missing there.
  std::optional<Priority> first_of(const Queues& queues) const {
    std::map<Priority, std::size_t> left;
    for (const Priority priority : Queues::kMostUrgentFirst) left[priority] = queues.queue(priority).size();
    std::optional<Priority> first;
    for (auto at = priorities_.rbegin(); at != priorities_.rend(); ++at) {
      if (left[*at] == 0) continue;
      --left[*at];
      first = *at;
    }
    return first;
  }

 private:
  std::deque<Priority> priorities_;
};

}  // namespace fieldproof::conformance
