// Slots that are processes of this machine.
#pragma once

#include <memory>

#include "campaign/job_process.hpp"
#include "campaign/slots.hpp"

namespace fieldproof::campaign {

class LocalSlots final : public Slots {
 public:
  explicit LocalSlots(std::size_t count) : count_(count) {}

  std::size_t free() const override { return count_ - running_.size(); }
  void give(const Job& job) override { running_.push_back(std::make_unique<JobProcess>(job)); }
  std::vector<JobResult> wait(std::chrono::milliseconds longest) override;
  void abandon() override { running_.clear(); }

 private:
  std::vector<JobResult> take_ended();

  std::size_t count_;
  std::vector<std::unique_ptr<JobProcess>> running_;
};

}  // namespace fieldproof::campaign
