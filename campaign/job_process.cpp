#include "campaign/job_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>
#include <system_error>
#include <vector>

#include "harness/config/document.hpp"
#include "harness/kernel/error.hpp"

extern char** environ;

namespace fieldproof::campaign {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kThisProgram = "/proc/self/exe";
constexpr const char* kLog = "log.txt";
constexpr std::size_t kLogKept = 2000;                             // octets
constexpr std::uintmax_t kLargestFile = std::uintmax_t{64} << 20;  // octets
constexpr std::size_t kMostFiles = 64;
constexpr std::size_t kMostOfCorpus = 20'000;
constexpr int kLostOutput = 74;
constexpr int kSignalBase = 128;

// What would decide something of the job, or would make it a rank.
bool is_of_this_place(std::string_view variable) {
  constexpr std::array<std::string_view, 4> kPrefixes = {"FIELDPROOF_", "OMPI_", "PMIX_", "PRTE_"};
  return std::ranges::any_of(kPrefixes, [&](auto prefix) { return variable.starts_with(prefix); });
}

// Between fork and exec: nothing that may take a lock.
[[noreturn]] void become(char* const* words, char* const* variables, int log, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::setpgid(0, 0);
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGQUIT, SIGHUP}) ::signal(signal, SIG_DFL);
  if (::getppid() != parent) ::_exit(kLostOutput);
  ::execve(kThisProgram, words, variables);
  ::_exit(127);
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::string last_of(const fs::path& file) {
  std::error_code failure;
  std::string text;
  const std::uintmax_t size = fs::file_size(file, failure);
  if (failure || size > kLargestFile) return {};
  text = config::read_text(file, kLargestFile);
  if (text.size() > kLogKept) text.erase(0, text.size() - kLogKept);
  return text;
}

// Documents, and what replay needs: a case file with the files that lie beside it.
bool is_kept(const fs::path& file) {
  constexpr std::array<std::string_view, 4> kNeeded = {"network.json", "plan.json", "pics.json", kDocument};
  const std::string name = file.filename().string();
  return name.ends_with("case.json") || std::ranges::find(kNeeded, name) != kNeeded.end();
}

}  // namespace

JobProcess::JobProcess(const Job& job) : job_(job) {
  std::error_code failure;
  std::string folder = (fs::temp_directory_path(failure) / "fieldproof-job-XXXXXX").string();
  if (failure || ::mkdtemp(folder.data()) == nullptr) {
    obstacle_ = fmt::format("a temporary folder cannot be made ({}): {}", folder, std::strerror(errno));
    obstacle_code_ = kLostOutput;
    return;
  }
  folder_ = folder;
  check_inputs();
  if (obstacle_.empty()) start();
}

JobProcess::~JobProcess() {
  end_group();
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

void JobProcess::check_inputs() {
  for (const judge::InputFile& input : job_.inputs) {
    try {
      if (judge::hash_of_file(input.path) == input.hash) continue;
      obstacle_ = fmt::format("{}: the file is another one here, or has changed since the campaign began",
                              input.path);
    } catch (const kernel::Error& error) {
      obstacle_ = error.what();
    }
    obstacle_code_ = 65;
    return;
  }
}

void JobProcess::start() {
  std::vector<std::string> words = {"fieldproof", job_.verb};
  words.insert(words.end(), job_.arguments.begin(), job_.arguments.end());
  words.insert(words.end(), job_.manner.begin(), job_.manner.end());
  for (const OutputFile& output : job_.outputs) {
    words.push_back(output.option);
    words.push_back((folder_ / output.name).string());
  }
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (!is_of_this_place(*variable)) variables.emplace_back(*variable);
  }
  const iut::Descriptor log(
      ::open((folder_ / kLog).c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
  const std::vector<char*> word_pointers = pointers_to(words);
  const std::vector<char*> variable_pointers = pointers_to(variables);
  const pid_t parent = ::getpid();
  begin_ = Clock::now();
  deadline_ = begin_ + job_.limit;
  // Not posix_spawn: it cannot ask for an end with the parent.
  id_ = ::fork();
  if (id_ == 0) become(word_pointers.data(), variable_pointers.data(), log.number(), parent);
  if (id_ > 0) ended_ = iut::Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, id_, 0)));
  if (id_ > 0 && ended_) return;
  obstacle_ = fmt::format("a process cannot be started: {}", std::strerror(errno));
  obstacle_code_ = kLostOutput;
}

void JobProcess::end_group() {
  if (id_ < 0) return;
  // As long as the leader can be waited for, its number is no other's.
  ::kill(-id_, SIGKILL);
  ::kill(id_, SIGKILL);
  int status = 0;
  while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
  }
  id_ = -1;
}

std::optional<JobResult> JobProcess::result() {
  JobResult result;
  result.id = job_.id;
  if (!obstacle_.empty()) {
    result.obstacle = obstacle_;
    result.obstacle_code = obstacle_code_;
    return result;
  }
  siginfo_t seen{};
  const bool has_ended =
      ::waitid(P_PID, static_cast<id_t>(id_), &seen, WEXITED | WNOHANG | WNOWAIT) == 0 && seen.si_pid == id_;
  if (!has_ended && Clock::now() < deadline_) return std::nullopt;
  end_group();
  result.wall_time_ms = static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - begin_).count());
  if (!has_ended) {
    result.loss = fmt::format("did not end within its limit of {} ms", job_.limit.count());
    return result;
  }
  // Also when it took a signal for its end in good order: a job ends by what it judged.
  const int by_signal =
      seen.si_code == CLD_EXITED ? std::max(0, seen.si_status - kSignalBase) : seen.si_status;
  if (by_signal > 0) {
    result.loss = fmt::format("was ended by signal {} ({})", by_signal, ::strsignal(by_signal));
    return result;
  }
  result.exit_code = seen.si_status;
  collect(result);
  if (result.exit_code == kLostOutput || result.exit_code == 127) {
    result.obstacle = result.exit_code == 127 ? "this program cannot be started again" : result.log;
    result.obstacle_code = kLostOutput;
  }
  return result;
}

void JobProcess::collect(JobResult& result) const {
  result.log = without_folder(last_of(folder_ / kLog));
  std::error_code failure;
  std::vector<fs::path> found;
  std::vector<fs::path> corpus;
  for (const auto& entry : fs::recursive_directory_iterator(folder_, failure)) {
    if (!entry.is_regular_file(failure) || entry.file_size(failure) > kLargestFile) continue;
    if (entry.path().parent_path() == folder_ / kCorpus) {
      corpus.push_back(entry.path());
    } else if (is_kept(entry.path())) {
      found.push_back(entry.path());
    }
  }
  std::ranges::sort(found);
  std::ranges::sort(corpus);
  if (found.size() > kMostFiles) found.resize(kMostFiles);
  if (corpus.size() > kMostOfCorpus) corpus.resize(kMostOfCorpus);
  found.insert(found.end(), corpus.begin(), corpus.end());
  for (const fs::path& file : found)
    result.files.push_back({file.lexically_relative(folder_).generic_string(), config::read_text(file)});
}

std::string JobProcess::without_folder(std::string text) const {
  const std::string folder = folder_.string();
  for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder, at))
    text.replace(at, folder.size(), ".");
  return text;
}

}  // namespace fieldproof::campaign
