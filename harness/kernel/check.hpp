// Checks of our own promises, on in every build: FIELDPROOF_CHECK(condition, "sentence") throws a
// BrokenInvariant when the condition does not hold. Its text has the expression, the sentence, file and line,
// and what this thread was doing: the case, its seed and the simulated time, as the innermost CheckContext
// tells them. Nothing in the house catches a BrokenInvariant to go on; the program prints it and ends with
// exit code 70.
//
// A CheckContext costs one store when it is made and one when it ends; its text is only composed when a check
// fails. Contexts nest per thread; the describing function must not throw and must outlive nothing but its
// own scope.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace fieldproof::kernel {

class BrokenInvariant : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

// While it lives, failures on this thread carry what `describe` returns, e.g. "case PROTOCOL/ROLE/..., seed
// 7, at 12 us".
class CheckContext {
 public:
  explicit CheckContext(std::function<std::string()> describe);
  ~CheckContext();
  CheckContext(const CheckContext&) = delete;
  CheckContext& operator=(const CheckContext&) = delete;

  // The contexts of this thread, outermost first, joined by "; ". Empty when there is none.
  static std::string describe_all();

 private:
  std::function<std::string()> describe_;
  CheckContext* outer_;
};

[[noreturn]] void throw_broken_invariant(const char* expression, const std::string& sentence,
                                         const char* file, int line);

}  // namespace fieldproof::kernel

#define FIELDPROOF_CHECK(condition, sentence) \
  (static_cast<bool>(condition)               \
       ? static_cast<void>(0)                 \
       : ::fieldproof::kernel::throw_broken_invariant(#condition, sentence, __FILE__, __LINE__))
