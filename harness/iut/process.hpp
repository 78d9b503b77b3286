#pragma once

#include <signal.h>
#include <sys/types.h>

#include <chrono>
#include <string>
#include <utility>
#include <vector>

// A child process in a process group of its own, so that it ends with all that it has started.
namespace fieldproof::iut {

// A descriptor that is closed with its owner.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor();

  int number() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }
  void close();

 private:
  int number_ = -1;
};

class Process {
 public:
  Process() = default;
  // Starts the program that the first word names, found as a shell finds it, with pipes at its standard
  // streams. Throws kernel::Error(implementation) when it cannot be started.
  explicit Process(const std::vector<std::string>& command);
  Process(Process&& other) noexcept { *this = std::move(other); }
  Process& operator=(Process&& other) noexcept;
  ~Process();  // ends the group

  Descriptor& to_input() { return to_input_; }
  Descriptor& from_output() { return from_output_; }
  Descriptor& from_errors() { return from_errors_; }

  // Waits so long for its end. Whether it has ended.
  bool has_ended(std::chrono::milliseconds longest_wait);
  // What the machine gives to its group: the processor time that it has had, and whether one of it is ready
  // to run or waits for the disk, so that nothing but the machine keeps it from going on.
  struct Effort {
    bool is_ready = false;
    std::chrono::milliseconds processor_time{};
  };
  Effort effort() const;
  // "ended with exit code 3", "was ended by signal 11 (Segmentation fault)"; of one that has ended.
  std::string how_it_ended() const;
  // All processes of the group, at once and for certain. What how_it_ended() says stays.
  void end_group();

 private:
  pid_t id_ = -1;
  bool has_ended_ = true;
  siginfo_t end_{};
  Descriptor to_input_;
  Descriptor from_output_;
  Descriptor from_errors_;
};

// The words of a command line: separated by blanks, with '...' and "..." around what has blanks. Throws
// kernel::Error(usage) for a quote that does not end, or no word at all.
std::vector<std::string> words_of(const std::string& command_line);

}  // namespace fieldproof::iut
