// The one exception for a request that cannot be served: an unknown id, a bad file, an impossible parameter,
// an implementation that cannot be attached. Its text is one sentence that says what is wrong, where (file
// and line, or JSON pointer), and what would be right. It is thrown where the cause is known and caught once,
// in the program. What happens on a line is never an Error: line faults are values. A broken promise of our
// own is a BrokenInvariant (check.hpp).
#pragma once

#include <stdexcept>
#include <string>

namespace fieldproof::kernel {

enum class ErrorKind {
  usage,           // the command line asks for something that does not exist (exit code 64)
  configuration,   // a configuration, plan, case or network file is wrong (exit code 65)
  implementation,  // the implementation under test cannot be used at all (exit code 5)
  output,          // a file, a device or a folder takes no result (exit code 74)
};

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& sentence) : std::runtime_error(sentence), kind_(kind) {}

  ErrorKind kind() const noexcept { return kind_; }

  // The process exit code that belongs to the kind: 64, 65, 5 or 74.
  int exit_code() const noexcept;

 private:
  ErrorKind kind_;
};

}  // namespace fieldproof::kernel
