#include "campaign/local_slots.hpp"

#include <poll.h>

#include <algorithm>
#include <utility>

namespace fieldproof::campaign {

std::vector<JobResult> LocalSlots::take_ended() {
  std::vector<JobResult> ended;
  std::erase_if(running_, [&](const std::unique_ptr<JobProcess>& job) {
    auto result = job->result();
    if (result) ended.push_back(std::move(*result));
    return result.has_value();
  });
  return ended;
}

std::vector<JobResult> LocalSlots::wait(std::chrono::milliseconds longest) {
  std::vector<JobResult> ended = take_ended();
  if (!ended.empty() || running_.empty()) return ended;
  std::vector<pollfd> ends;
  auto until = std::chrono::steady_clock::now() + longest;
  for (const auto& job : running_) {
    ends.push_back({job->descriptor(), POLLIN, 0});
    until = std::min(until, job->deadline());
  }
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
  // A signal ends it early, and whoever asks looks what it was.
  ::poll(ends.data(), ends.size(), static_cast<int>(std::max(left, std::chrono::milliseconds(0)).count()));
  return take_ended();
}

}  // namespace fieldproof::campaign
