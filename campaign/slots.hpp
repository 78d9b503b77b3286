// Where jobs run: so many at a time, each in a slot. What distributes them does not know whether a slot is a
// process of this machine or a rank on another.
//
// Contract: each job that was given comes back as one result, in any order, unless it is abandoned.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "campaign/job.hpp"

namespace fieldproof::campaign {

class Slots {
 public:
  Slots() = default;
  Slots(const Slots&) = delete;
  Slots& operator=(const Slots&) = delete;
  virtual ~Slots() = default;

  // How many jobs can be given now.
  virtual std::size_t free() const = 0;
  virtual void give(const Job& job) = 0;
  // What has ended, waiting at most so long for the first; with nothing running it comes back at once.
  virtual std::vector<JobResult> wait(std::chrono::milliseconds longest) = 0;
  // The end: kills all that runs; their results are never handed over, and nothing is given any more.
  virtual void abandon() = 0;
};

}  // namespace fieldproof::campaign
