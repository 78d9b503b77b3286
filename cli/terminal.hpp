// Where the program writes: the result on standard output, everything else on standard error.
//
// Contract: colours only when standard output is a terminal that knows them and NO_COLOR is not set; the
// progress bar only when standard error is a terminal and the call is not quiet. A line of the result never
// lands inside the bar. Output is flushed line by line, so that what a person saw is what a log has. A log
// that nobody can take is lost without a word; a result that is lost is remembered (`has_lost_result`).
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace fieldproof::cli {

class Terminal {
 public:
  Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal() { clear_progress(); }

  bool has_colour() const { return has_colour_; }
  void set_quiet(bool is_quiet) { is_quiet_ = is_quiet; }
  bool is_quiet() const { return is_quiet_; }

  void print(std::string_view text);  // the result
  void log(std::string_view text);    // one line for a person, on standard error

  // Standard output took not all of the result: its disk is full, its reader has gone.
  bool has_lost_result() const { return has_lost_result_; }

  // Starts a bar for `total` pieces of work; `what` is their plural.
  void begin_progress(std::size_t total, std::string_view what);
  void progress(std::size_t done);
  void end_progress();

 private:
  void draw();
  void clear_progress();

  bool has_colour_ = false;
  bool has_bar_ = false;
  bool is_quiet_ = false;
  bool is_drawn_ = false;
  bool has_lost_result_ = false;
  std::size_t total_ = 0;
  std::size_t done_ = 0;
  std::string what_;
  std::chrono::steady_clock::time_point begin_{};
  std::chrono::steady_clock::time_point last_draw_{};
};

// Puts /dev/null in the place of a standard stream that is closed, so that no file or pipe of the program
// gets its number and receives what is printed; and lets a write to a reader that has gone fail instead of
// killing.
void secure_standard_streams();

// "fieldproof: text" on standard error, as one line that cannot steer a terminal: a sentence may quote a
// file.
void print_log_line(std::string_view text);

// "[######----]  12/30  40 %  3.1 cases/s  6 s left"; the rate and the rest are left out before they are
// known.
std::string progress_text(std::size_t done, std::size_t total, double seconds, std::string_view what);

}  // namespace fieldproof::cli
