#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "harness/kernel/error.hpp"

// What an implementation outside of the bench did that no station can: it died, hung, talked nonsense. It is
// a verdict about it with a reason of its own, never the end of a run.
namespace fieldproof::iut {

namespace reasons {
inline constexpr std::string_view kCrashed = "implementation_crashed";  // a signal, an exit code
inline constexpr std::string_view kGone = "implementation_gone";        // closed its connection
inline constexpr std::string_view kHangs = "implementation_hangs";
inline constexpr std::string_view kFloods = "implementation_floods";
inline constexpr std::string_view kGarbage = "implementation_sends_garbage";
inline constexpr std::string_view kImpossible = "implementation_asks_the_impossible";
inline constexpr std::string_view kNoneDelivered = "delivers_what_is_none";  // to its user
inline constexpr std::string_view kDiedBetweenCases = "implementation_died_between_cases";
inline constexpr std::string_view kUnsupported = "implementation_refuses_case";
}  // namespace reasons

class Misbehaviour : public kernel::Error {
 public:
  // `evidence`: lines that show it, such as the octets that are none of the protocol, or the end of its log.
  Misbehaviour(std::string_view reason, const std::string& sentence, std::vector<std::string> evidence = {})
      : Error(kernel::ErrorKind::implementation, sentence), reason_(reason), evidence_(std::move(evidence)) {}

  const std::string& reason() const { return reason_; }
  const std::vector<std::string>& evidence() const { return evidence_; }

 private:
  std::string reason_;
  std::vector<std::string> evidence_;
};

// What a case asks for and this attachment cannot do: the case does not apply to it. The sentence says what.
class CannotBeDone : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What this attachment did too late for a verdict on what follows: the instants of the case are in doubt.
class InDoubt : public CannotBeDone {
 public:
  using CannotBeDone::CannotBeDone;
};

}  // namespace fieldproof::iut
