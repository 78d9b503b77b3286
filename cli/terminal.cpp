#include "cli/terminal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

bool is_dumb() {
  const char* kind = std::getenv("TERM");
  return kind == nullptr || std::string_view(kind) == "dumb";
}

bool refuses_colour() {
  const char* value = std::getenv("NO_COLOR");
  return value != nullptr && *value != '\0';
}

// A log that cannot be written must not end the program.
void write_to_log(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::string time_left(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 100) return fmt::format("{} s left", whole);
  return fmt::format("{}:{:02} min left", whole / 60, whole % 60);
}

}  // namespace

Terminal::Terminal()
    : has_colour_(isatty(STDOUT_FILENO) == 1 && !is_dumb() && !refuses_colour()),
      has_bar_(isatty(STDERR_FILENO) == 1 && !is_dumb()) {}

void Terminal::print(std::string_view text) {
  clear_progress();
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if ((is_written && std::fflush(stdout) == 0) || has_lost_result_) return;
  has_lost_result_ = true;
  log(fmt::format("the result cannot be written to standard output: {}", std::strerror(errno)));
}

void Terminal::log(std::string_view text) {
  clear_progress();
  print_log_line(text);
}

void Terminal::begin_progress(std::size_t total, std::string_view what) {
  total_ = total;
  done_ = 0;
  what_ = what;
  begin_ = std::chrono::steady_clock::now();
  last_draw_ = {};
}

void Terminal::progress(std::size_t done) {
  done_ = done;
  if (!has_bar_ || is_quiet_ || total_ == 0) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_draw_ < std::chrono::milliseconds(100)) return;
  last_draw_ = now;
  draw();
}

void Terminal::end_progress() {
  clear_progress();
  total_ = 0;
}

void Terminal::draw() {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  write_to_log("\r\033[K" + progress_text(done_, total_, seconds, what_));
  is_drawn_ = true;
}

void Terminal::clear_progress() {
  if (!is_drawn_) return;
  write_to_log("\r\033[K");
  is_drawn_ = false;
}

void secure_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // The lowest free number is given, and those below are taken.
    if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    [[maybe_unused]] const int opened = open("/dev/null", O_RDWR);
  }
  std::signal(SIGPIPE, SIG_IGN);
}

void print_log_line(std::string_view text) {
  // A sentence quotes what is wrong, and that may be a whole file. What would be right is at its end.
  constexpr std::size_t kLongest = 1'600;
  std::string cut;
  if (text.size() > kLongest) {
    cut = fmt::format("{} ... {}", text.substr(0, kLongest / 2), text.substr(text.size() - kLongest / 2));
    text = cut;
  }
  write_to_log(fmt::format("fieldproof: {}\n", reports::escaped_line(text)));
}

std::string progress_text(std::size_t done, std::size_t total, double seconds, std::string_view what) {
  constexpr std::size_t kWidth = 24;
  const std::size_t filled = total == 0 ? kWidth : done * kWidth / total;
  const std::size_t percent = total == 0 ? 100 : done * 100 / total;
  std::string text = fmt::format("[{:#<{}}{:-<{}}]  {}/{} {}  {} %", "", filled, "", kWidth - filled, done,
                                 total, what, percent);
  if (done > 0 && seconds > 0) {
    const double rate = static_cast<double>(done) / seconds;
    text += fmt::format("  {:.1f} {}/s  {}", rate, what, time_left(static_cast<double>(total - done) / rate));
  }
  return text;
}

}  // namespace fieldproof::cli
