// Calls a program as a shell does and keeps what it printed, for tests. Each call has its own environment, so
// that a variable of the machine decides nothing.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace fieldproof::cli {

struct Called {
  int exit_code = -1;  // 128 + n when signal n ended it
  std::string out;
  std::string err;
};

struct Call {
  std::string program;
  std::vector<std::string> arguments;
  std::filesystem::path folder;
  std::map<std::string, std::string> environment;
  bool on_terminal = false;  // standard output and error are one terminal; `out` holds both
  int signal = 0;            // sent when the output holds `signal_after` and `signal_file` is in the folder
  std::string signal_after;
  std::string signal_file;  // empty: none is waited for
  // Sent once more so much later; zero: not.
  std::chrono::milliseconds again_after{};

  Called run() const;

 private:
  [[noreturn]] void become_program(int out, int err) const;
  bool is_signal_due(const std::string& out) const {
    return out.find(signal_after) != std::string::npos &&
           (signal_file.empty() || std::filesystem::exists(folder / signal_file));
  }
};

// The whole path of a program that the system has; empty where it has none.
inline std::string installed(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::stringstream folders(std::string("/usr/bin:/bin:/usr/local/bin:") + (path == nullptr ? "" : path));
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (std::filesystem::exists(std::filesystem::path(folder) / name))
      return (std::filesystem::path(folder) / name).string();
  }
  return {};
}

inline std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) std::abort();
  return ends;
}

// The two ends of a pseudo terminal: the test's, the program's.
inline std::array<int, 2> make_terminal() {
  const int ours = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (ours < 0 || grantpt(ours) != 0 || unlockpt(ours) != 0) std::abort();
  return {ours, open(ptsname(ours), O_RDWR | O_NOCTTY | O_CLOEXEC)};
}

// False at the end of the stream; a terminal ends with an error.
inline bool read_some(int from, std::string& into) {
  std::array<char, 4096> buffer{};
  const ssize_t count = read(from, buffer.data(), buffer.size());
  if (count <= 0) return false;
  into.append(buffer.data(), static_cast<std::size_t>(count));
  return true;
}

inline void Call::become_program(int out, int err) const {
  if (chdir(folder.c_str()) != 0 || dup2(out, STDOUT_FILENO) < 0 || dup2(err, STDERR_FILENO) < 0) _exit(126);
  std::vector<char*> words;
  words.push_back(const_cast<char*>(program.c_str()));
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  std::map<std::string, std::string> all = environment;
  all.try_emplace("PATH", "/usr/bin:/bin");
  all.try_emplace("TERM", "xterm");
  all.try_emplace("SOURCE_DATE_EPOCH", "1764201600");  // equal calls write equal documents
  std::vector<std::string> lines;
  for (const auto& [name, value] : all) lines.push_back(name + "=" + value);
  std::vector<char*> variables;
  for (std::string& line : lines) variables.push_back(line.data());
  variables.push_back(nullptr);
  execve(program.c_str(), words.data(), variables.data());
  _exit(127);
}

inline Called Call::run() const {
  const auto out = on_terminal ? make_terminal() : make_pipe();
  const auto err = make_pipe();
  const pid_t child = fork();
  if (child == 0) become_program(out[1], on_terminal ? out[1] : err[1]);
  close(out[1]);
  close(err[1]);
  Called called;
  std::array<pollfd, 2> open_ends{pollfd{out[0], POLLIN, 0}, pollfd{err[0], POLLIN, 0}};
  bool is_sent = signal == 0;
  while (open_ends[0].fd >= 0 || open_ends[1].fd >= 0) {
    poll(open_ends.data(), open_ends.size(), is_sent ? -1 : 10);
    for (std::size_t i = 0; i < open_ends.size(); ++i) {
      if (open_ends[i].fd < 0 || open_ends[i].revents == 0) continue;
      if (!read_some(open_ends[i].fd, i == 0 ? called.out : called.err)) open_ends[i].fd = -1;
    }
    if (!is_sent && is_signal_due(called.out)) {
      kill(child, signal);
      if (again_after.count() > 0) {
        std::this_thread::sleep_for(again_after);
        kill(child, signal);
      }
      is_sent = true;
    }
  }
  close(out[0]);
  close(err[0]);
  int status = 0;
  waitpid(child, &status, 0);
  called.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return called;
}

}  // namespace fieldproof::cli
