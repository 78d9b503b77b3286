// A job while it runs: a process of this program itself, in a folder of its own, so that a crash, a kill or a
// hang of a job takes nobody along.
//
// Contract: the process has its own process group, no standard input, and none of the variables that would
// decide something (FIELDPROOF_*) or make it one of the ranks that started it. It is ended with this thread,
// however that ends. Its result does not depend on the folder: where its words name it, "." stands.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "campaign/job.hpp"
#include "harness/iut/process.hpp"

namespace fieldproof::campaign {

class JobProcess {
 public:
  explicit JobProcess(const Job& job);
  JobProcess(JobProcess&&) = delete;
  ~JobProcess();  // kills it

  // Readable when the process has ended.
  int descriptor() const { return ended_.number(); }
  std::chrono::steady_clock::time_point deadline() const { return deadline_; }
  // Its result, when it has ended or was over its limit and is now ended.
  std::optional<JobResult> result();

 private:
  void check_inputs();
  void start();
  void end_group();
  JobResult described(int status);
  void collect(JobResult& result) const;
  std::string without_folder(std::string text) const;

  Job job_;
  std::filesystem::path folder_;
  pid_t id_ = -1;
  iut::Descriptor ended_;
  std::chrono::steady_clock::time_point begin_{};
  std::chrono::steady_clock::time_point deadline_{};
  std::string obstacle_;
  int obstacle_code_ = 0;
};

}  // namespace fieldproof::campaign
