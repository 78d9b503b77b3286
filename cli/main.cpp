#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

#include "cli/program.hpp"
#include "cli/protocols.hpp"

namespace {

constexpr int kImplementationEnds = 5;
bool has_come_to_its_end = false;

// A library that is attached with ?in-process can end the program: what it was judged by so far is no result.
[[noreturn]] void end(int code) {
  if (!has_come_to_its_end) {
    constexpr std::string_view kSentence =
        "fieldproof: ended by the library that is attached with ?in-process, before all was done; "
        "in a process of its own (without ?in-process) its end is a verdict\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kSentence.data(), kSentence.size());
    code = kImplementationEnds;
  }
  ::syscall(SYS_exit_group, code);
  std::abort();
}

// Nothing may be left to do here when it came to its end: what is flushed after this would be lost.
void end_early() {
  if (!has_come_to_its_end) end(kImplementationEnds);
}

}  // namespace

// Seen by libraries in the place of that of the C library. Sanitizers have one of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__has_feature)
extern "C" {
[[noreturn]] void _exit(int code) {
  end(code);
}
[[noreturn]] void _Exit(int code) {
  end(code);
}
}
#endif

int main(int argc, char** argv) {
  std::atexit(end_early);
  std::at_quick_exit(end_early);
  const int code = fieldproof::cli::run_program(argc, argv, fieldproof::cli::built_in_protocols());
  has_come_to_its_end = true;
  return code;
}
