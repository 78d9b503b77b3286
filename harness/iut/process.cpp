#include "harness/iut/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>
#include <system_error>
#include <thread>

#include "harness/kernel/error.hpp"

extern char** environ;

namespace fieldproof::iut {
namespace {

using std::chrono::milliseconds;

[[noreturn]] void refuse(const std::string& what, int error) {
  throw kernel::Error(kernel::ErrorKind::implementation,
                      fmt::format("{}: {}", what, std::system_category().message(error)));
}

struct Pipe {
  Descriptor read;
  Descriptor write;
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse("a pipe cannot be made", errno);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

// A write to a process that has ended must be an error, not the end of this one.
void ignore_broken_pipes() {
  static std::once_flag once;
  std::call_once(once, [] {
    struct sigaction now{};
    ::sigaction(SIGPIPE, nullptr, &now);
    if (now.sa_handler == SIG_DFL) ::signal(SIGPIPE, SIG_IGN);
  });
}

// The attributes of a child: its own group, and signals as a shell would give them.
class SpawnAttributes {
 public:
  SpawnAttributes() {
    ::posix_spawnattr_init(&attributes_);
    ::posix_spawnattr_setflags(&attributes_,
                               POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    ::posix_spawnattr_setpgroup(&attributes_, 0);
    sigset_t set;
    ::sigemptyset(&set);
    ::posix_spawnattr_setsigmask(&attributes_, &set);
    for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGQUIT, SIGHUP}) ::sigaddset(&set, signal);
    ::posix_spawnattr_setsigdefault(&attributes_, &set);
  }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  ~SpawnAttributes() { ::posix_spawnattr_destroy(&attributes_); }
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

class SpawnActions {
 public:
  SpawnActions() { ::posix_spawn_file_actions_init(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
  ~SpawnActions() { ::posix_spawn_file_actions_destroy(&actions_); }
  void put(const Descriptor& descriptor, int as) {
    ::posix_spawn_file_actions_adddup2(&actions_, descriptor.number(), as);
  }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

}  // namespace

Descriptor::~Descriptor() {
  close();
}

void Descriptor::close() {
  if (number_ >= 0) ::close(std::exchange(number_, -1));
}

Process::Process(const std::vector<std::string>& command) {
  ignore_broken_pipes();
  Pipe input = make_pipe();
  Pipe output = make_pipe();
  Pipe errors = make_pipe();
  SpawnActions actions;
  actions.put(input.read, STDIN_FILENO);
  actions.put(output.write, STDOUT_FILENO);
  actions.put(errors.write, STDERR_FILENO);
  const SpawnAttributes attributes;
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int failure =
      ::posix_spawnp(&id_, arguments.front(), actions.get(), attributes.get(), arguments.data(), environ);
  if (failure != 0) refuse(fmt::format("'{}' cannot be started", command.front()), failure);
  has_ended_ = false;
  to_input_ = std::move(input.write);
  from_output_ = std::move(output.read);
  from_errors_ = std::move(errors.read);
  // Neither a full pipe nor an empty log may keep the bench.
  ::fcntl(to_input_.number(), F_SETFL, O_NONBLOCK);
  ::fcntl(from_errors_.number(), F_SETFL, O_NONBLOCK);
}

Process& Process::operator=(Process&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(has_ended_, other.has_ended_);
  std::swap(end_, other.end_);
  std::swap(to_input_, other.to_input_);
  std::swap(from_output_, other.from_output_);
  std::swap(from_errors_, other.from_errors_);
  return *this;
}

Process::~Process() {
  end_group();
}

// Looks and does not take it away: as long as the leader can still be waited for its number is no other's,
// and so the signal to its group reaches nobody else.
bool Process::has_ended(milliseconds longest_wait) {
  const auto until = std::chrono::steady_clock::now() + longest_wait;
  while (!has_ended_) {
    siginfo_t seen{};
    const int failure = ::waitid(P_PID, static_cast<id_t>(id_), &seen, WEXITED | WNOHANG | WNOWAIT);
    if (failure == 0 && seen.si_pid == id_) {
      end_ = seen;
      has_ended_ = true;
      break;
    }
    if (std::chrono::steady_clock::now() >= until) return false;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return true;
}

Process::Effort Process::effort() const {
  Effort effort;
  const double ticks_per_ms = static_cast<double>(::sysconf(_SC_CLK_TCK)) / 1e3;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", failure)) {
    // One that ends while it is looked at is an empty line.
    std::string line;
    std::getline(std::ifstream(entry.path() / "stat"), line);
    // Its name may hold anything; state, parent and group come after.
    const std::size_t name_end = line.rfind(')');
    if (name_end == std::string::npos) continue;
    std::istringstream fields(line.substr(name_end + 1));
    char state = 0;
    pid_t parent = 0;
    pid_t group = 0;
    fields >> state >> parent >> group;
    if (group != id_) continue;
    std::string skipped;
    for (int n = 0; n < 8; ++n)
      fields >> skipped;  // session, terminal, its group, flags, four kinds of faults
    double user = 0;
    double system = 0;
    fields >> user >> system;
    effort.is_ready |= state == 'R' || state == 'D';
    effort.processor_time += milliseconds(std::llround((user + system) / ticks_per_ms));
  }
  return effort;
}

std::string Process::how_it_ended() const {
  if (end_.si_code != CLD_EXITED) {
    return fmt::format("was ended by signal {} ({})", end_.si_status, ::strsignal(end_.si_status));
  }
  return fmt::format("ended with exit code {}", end_.si_status);
}

void Process::end_group() {
  if (id_ < 0) return;
  // Children of an ended leader keep its group.
  ::kill(-id_, SIGKILL);
  ::kill(id_, SIGKILL);
  siginfo_t last{};
  while (::waitid(P_PID, static_cast<id_t>(id_), &last, WEXITED) != 0 && errno == EINTR) {
  }
  if (!has_ended_) end_ = last;
  has_ended_ = true;
  id_ = -1;
}

std::vector<std::string> words_of(const std::string& command_line) {
  std::vector<std::string> words;
  bool is_in_word = false;
  char quote = 0;
  for (const char c : command_line) {
    if (quote != 0) {
      if (c == quote) {
        quote = 0;
      } else {
        words.back() += c;
      }
      continue;
    }
    if (c == ' ' || c == '\t') {
      is_in_word = false;
      continue;
    }
    if (!is_in_word) words.emplace_back();
    is_in_word = true;
    if (c == '\'' || c == '"') {
      quote = c;
    } else {
      words.back() += c;
    }
  }
  if (quote != 0) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("the command '{}' has a quote {} that does not end", command_line, quote));
  }
  if (words.empty() || words.front().empty()) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        "the command of exec: is empty; write exec:./program ARGUMENTS");
  }
  return words;
}

}  // namespace fieldproof::iut
