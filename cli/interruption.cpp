#include "cli/interruption.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <limits>

#include "harness/kernel/check.hpp"

namespace fieldproof::cli {
namespace {

constexpr char kSignalCame = 's';
constexpr char kEnd = 'e';

// A handler may touch lock-free atomics and call what POSIX allows there: write, clock_gettime, signal,
// raise.
std::atomic<int> received{0};
std::atomic<std::int64_t> received_at{0};  // ms
std::atomic<int> wake_end{-1};

// What asks a program to stop may ask its group, too: the same request comes twice. One that comes later is
// somebody who does not want to wait.
constexpr std::int64_t kSameRequest = 1'000;  // ms

std::int64_t monotonic_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000 + now.tv_nsec / 1'000'000;
}

extern "C" void on_signal(int signal) {
  const int former_errno = errno;
  const std::int64_t now = monotonic_milliseconds();
  if (received.load() != 0) {
    if (now - received_at.load() > kSameRequest) {
      ::signal(signal, SIG_DFL);
      ::raise(signal);
    }
    errno = former_errno;
    return;
  }
  received_at.store(now);
  received.store(signal);
  [[maybe_unused]] const auto written = write(wake_end.load(), &kSignalCame, 1);
  errno = former_errno;
}

void install(int signal, struct sigaction& former) {
  struct sigaction action{};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, &former);
}

// For poll: milliseconds, -1 for ever.
int observation_timeout_until(std::chrono::steady_clock::time_point deadline) {
  if (deadline == std::chrono::steady_clock::time_point::max()) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
  return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, std::numeric_limits<int>::max()));
}

}  // namespace

Interruption::Interruption(std::optional<std::chrono::milliseconds> max_time) {
  FIELDPROOF_CHECK(pipe2(wake_, O_CLOEXEC | O_NONBLOCK) == 0,
                   "the system gives no pipe for the signal handler");
  received = 0;
  wake_end = wake_[1];
  install(SIGINT, former_int_);
  install(SIGTERM, former_term_);
  const Clock::time_point deadline = max_time ? Clock::now() + *max_time : Clock::time_point::max();
  watcher_ = std::jthread([this, deadline] { watch(deadline); });
}

Interruption::~Interruption() {
  [[maybe_unused]] const auto written = write(wake_[1], &kEnd, 1);
  watcher_.join();
  sigaction(SIGINT, &former_int_, nullptr);
  sigaction(SIGTERM, &former_term_, nullptr);
  wake_end = -1;
  close(wake_[0]);
  close(wake_[1]);
}

int Interruption::signal() const {
  return received.load();
}

std::string Interruption::reason() const {
  if (signal() == SIGINT) return "interrupted by SIGINT";
  if (signal() == SIGTERM) return "interrupted by SIGTERM";
  return is_out_of_time() ? "the time of --max-time was over" : "";
}

void Interruption::watch(Clock::time_point deadline) {
  while (true) {
    pollfd wake{wake_[0], POLLIN, 0};
    const int ready = poll(&wake, 1, observation_timeout_until(deadline));
    if (ready < 0 && errno == EINTR) continue;
    if (ready > 0) {
      char byte = 0;
      if (read(wake_[0], &byte, 1) != 1) continue;
      if (byte == kEnd) return;
      if (byte == kSignalCame) source_.request_stop();
      continue;
    }
    if (Clock::now() < deadline) continue;
    is_out_of_time_ = true;
    source_.request_stop();
    // Stays for the end of the object; a time that is over must not be found again.
    deadline = Clock::time_point::max();
  }
}

}  // namespace fieldproof::cli
