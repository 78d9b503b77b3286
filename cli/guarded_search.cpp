#include "cli/guarded_search.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string_view>

#include "harness/iut/process.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::cli {
namespace {

constexpr std::size_t kMostOctets = 65'536;
constexpr std::size_t kMostGrowth = 64;  // points; a search of 10^9 sequences has 30
constexpr std::size_t kLongestError = 4'096;
constexpr std::chrono::milliseconds kLook{100};
constexpr std::chrono::seconds kLongestSequence{120};

// What asks this process to end is for the child, which ends in good order.
std::atomic<pid_t> child_of_signals{0};

extern "C" void hand_on(int signal) {
  const int former_errno = errno;
  if (const pid_t child = child_of_signals.load(); child > 0) ::kill(child, signal);
  errno = former_errno;
}

class HandedOnSignals {
 public:
  explicit HandedOnSignals(pid_t child) {
    child_of_signals = child;
    struct sigaction action{};
    action.sa_handler = hand_on;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (std::size_t n = 0; n < kSignals.size(); ++n) ::sigaction(kSignals[n], &action, &former_[n]);
  }
  ~HandedOnSignals() {
    for (std::size_t n = 0; n < kSignals.size(); ++n) ::sigaction(kSignals[n], &former_[n], nullptr);
    child_of_signals = 0;
  }
  HandedOnSignals(const HandedOnSignals&) = delete;
  HandedOnSignals& operator=(const HandedOnSignals&) = delete;

  static constexpr std::array kSignals = {SIGINT, SIGTERM};

 private:
  std::array<struct sigaction, kSignals.size()> former_{};
};

std::string how_it_ended(int status, bool hangs) {
  if (hangs) return fmt::format("did not come back from a sequence within {} s", kLongestSequence.count());
  if (WIFSIGNALED(status))
    return fmt::format("was ended by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  return fmt::format("ended by itself with exit code {}", WEXITSTATUS(status));
}

}  // namespace

// Plain memory only: whoever reads it may do so after a crash of whoever wrote it.
struct GuardedSearch::Shared {
  enum class End : std::uint8_t { none, code, error, failure };
  std::atomic<std::uint64_t> sequences{0};
  std::atomic<bool> is_searching{false};
  std::atomic<End> end{End::none};
  int code = 0;
  kernel::ErrorKind kind{};
  std::array<char, kLongestError> error{};
  void keep(End how, std::string_view text) {
    text.copy(error.data(), kLongestError - 1);
    end = how;
  }

  std::uint64_t run = 0;
  std::size_t seeds_run = 0;
  std::uint64_t passed = 0;
  std::uint64_t silent = 0;
  std::uint64_t inconclusive = 0;
  std::size_t edges = 0;
  std::size_t growths = 0;
  std::array<fuzz::GrowthPoint, kMostGrowth> growth{};
  std::size_t size = 0;
  std::array<std::uint8_t, kMostOctets> octets{};
};

GuardedSearch::GuardedSearch() {
  void* memory = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  FIELDPROOF_CHECK(memory != MAP_FAILED, "the system gives no memory for two processes");
  shared_ = new (memory) Shared;
  kept_ = ::memfd_create("kept", MFD_CLOEXEC);
  FIELDPROOF_CHECK(kept_ >= 0, "the system gives no file without a name");
}

GuardedSearch::~GuardedSearch() {
  ::munmap(shared_, sizeof(Shared));
  ::close(kept_);
}

void GuardedSearch::begins(const fuzz::SequenceFuzzResult& before, std::span<const std::uint8_t> octets) {
  shared_->run = before.run;
  shared_->seeds_run = before.seeds_run;
  shared_->passed = before.passed;
  shared_->silent = before.silent;
  shared_->inconclusive = before.inconclusive;
  shared_->edges = before.edges;
  shared_->growths = std::min(before.growth.size(), kMostGrowth);
  std::copy_n(before.growth.begin(), shared_->growths, shared_->growth.begin());
  shared_->size = std::min(octets.size(), kMostOctets);
  std::copy_n(octets.begin(), shared_->size, shared_->octets.begin());
  shared_->is_searching = true;
  ++shared_->sequences;
}

// In one write, so that there is never half of one.
void GuardedSearch::keeps(std::span<const std::uint8_t> octets) const {
  const auto size = static_cast<std::uint32_t>(octets.size());
  std::vector<std::uint8_t> record(sizeof size + octets.size());
  std::memcpy(record.data(), &size, sizeof size);
  std::ranges::copy(octets, record.begin() + sizeof size);
  [[maybe_unused]] const auto written = ::write(kept_, record.data(), record.size());
}

// To make it smaller takes as long as it takes.
void GuardedSearch::has_found() {
  shared_->is_searching = false;
}

void GuardedSearch::be_the_child(const std::function<int()>& work) {
  try {
    shared_->code = work();
    shared_->end = Shared::End::code;
  } catch (const kernel::Error& error) {
    shared_->kind = error.kind();
    shared_->keep(Shared::End::error, error.what());
  } catch (const std::exception& failure) {
    // Ours, and no fault of the library.
    shared_->keep(Shared::End::failure, failure.what());
  }
  std::fflush(nullptr);
  // Nothing that belongs to the parent is to be ended here.
  ::syscall(SYS_exit_group, 0);
  std::abort();
}

int GuardedSearch::status_of(int child) {
  using Clock = std::chrono::steady_clock;
  // Only so that its end is seen at once.
  const iut::Descriptor ended(static_cast<int>(::syscall(SYS_pidfd_open, child, 0)));
  pollfd end{ended.number(), POLLIN, 0};
  std::uint64_t sequences = 0;
  auto since = Clock::now();
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    ::poll(&end, 1, static_cast<int>(kLook.count()));
    const std::uint64_t now = shared_->sequences;
    if (now != sequences || !shared_->is_searching) {
      sequences = now;
      since = Clock::now();
    } else if (Clock::now() - since > kLongestSequence && !hangs_) {
      hangs_ = true;
      ::kill(child, SIGKILL);
    }
  }
  return status;
}

std::optional<int> GuardedSearch::run(const std::function<int()>& work) {
  sigset_t asked{};
  sigset_t former{};
  sigemptyset(&asked);
  for (const int signal : HandedOnSignals::kSignals) sigaddset(&asked, signal);
  std::fflush(nullptr);
  ::pthread_sigmask(SIG_BLOCK, &asked, &former);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::syscall(SYS_exit_group, 0);
    ::pthread_sigmask(SIG_SETMASK, &former, nullptr);
    be_the_child(work);
  }
  FIELDPROOF_CHECK(child > 0, "the system gives no process for the search");
  int status = 0;
  {
    const HandedOnSignals handed_on(child);
    ::pthread_sigmask(SIG_SETMASK, &former, nullptr);
    status = status_of(child);
  }
  if (shared_->end == Shared::End::error) throw kernel::Error(shared_->kind, shared_->error.data());
  if (shared_->end == Shared::End::failure) throw std::runtime_error(shared_->error.data());
  if (shared_->end == Shared::End::code) return shared_->code;
  read_what_was_left(status);
  return std::nullopt;
}

void GuardedSearch::read_what_was_left(int status) {
  broken_.how = how_it_ended(status, hangs_);
  broken_.hangs = hangs_;
  broken_.octets.assign(shared_->octets.begin(),
                        shared_->octets.begin() + static_cast<std::ptrdiff_t>(shared_->size));
  fuzz::SequenceFuzzResult& before = broken_.before;
  before.run = shared_->run;
  before.seeds_run = shared_->seeds_run;
  before.passed = shared_->passed;
  before.silent = shared_->silent;
  before.inconclusive = shared_->inconclusive;
  before.edges = shared_->edges;
  before.has_coverage = shared_->edges > 0;
  before.growth.assign(shared_->growth.begin(),
                       shared_->growth.begin() + static_cast<std::ptrdiff_t>(shared_->growths));
  constexpr auto kHead = static_cast<ssize_t>(sizeof(std::uint32_t));
  std::uint32_t size = 0;
  for (off_t at = 0; ::pread(kept_, &size, sizeof size, at) == kHead;) {
    std::vector<std::uint8_t> octets(std::min<std::size_t>(size, kMostOctets));
    at += kHead;
    if (::pread(kept_, octets.data(), octets.size(), at) != static_cast<ssize_t>(octets.size())) break;
    at += static_cast<off_t>(size);
    broken_.kept.push_back(std::move(octets));
  }
  before.kept = broken_.kept.size();
}

}  // namespace fieldproof::cli
