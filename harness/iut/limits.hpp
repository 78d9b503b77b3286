#pragma once

#include <chrono>

namespace fieldproof::iut {

// How long an implementation in another process may take, in time of the machine. No verdict about a line
// rests on it: it bounds one that hangs.
struct PeerLimits {
  std::chrono::milliseconds start{5'000};         // for its first answer
  std::chrono::milliseconds call{2'000};          // for each other one
  std::chrono::milliseconds whole_case{600'000};  // for all calls of a case
};

}  // namespace fieldproof::iut
