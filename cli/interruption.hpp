// Turns SIGINT, SIGTERM and the end of `--max-time` into a stop of the work.
//
// Contract: the first signal asks for a stop, so that the partial result is written; a second one of the same
// kind kills at once. One object at a time; signals get their former handlers back at its end.
#pragma once

#include <atomic>
#include <chrono>
#include <csignal>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

namespace fieldproof::cli {

class Interruption {
 public:
  explicit Interruption(std::optional<std::chrono::milliseconds> max_time);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  std::stop_token token() const { return source_.get_token(); }

  // SIGINT or SIGTERM, 0 when none came.
  int signal() const;
  bool is_out_of_time() const { return is_out_of_time_.load(); }

  // "interrupted by SIGINT", "the time of --max-time was over", or nothing.
  std::string reason() const;

 private:
  using Clock = std::chrono::steady_clock;
  void watch(Clock::time_point deadline);

  std::stop_source source_;
  std::atomic<bool> is_out_of_time_{false};
  int wake_[2] = {-1, -1};
  struct sigaction former_int_{};
  struct sigaction former_term_{};
  std::jthread watcher_;
};

}  // namespace fieldproof::cli
