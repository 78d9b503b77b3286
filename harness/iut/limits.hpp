#pragma once

#include <chrono>

namespace fieldproof::iut {

// What an implementation may do within one call, and how often it may ask for a call where time stands still;
// more is a flood. A master of the most words tells both images and reads as many orders: some 12'300.
inline constexpr unsigned kMostActions = 20'000;

// How long an implementation in another process may take, in time of the machine. No verdict about a line
// rests on it: it bounds one that hangs.
struct PeerLimits {
  std::chrono::milliseconds start{5'000};         // for its first answer
  std::chrono::milliseconds call{2'000};          // for each other one
  std::chrono::milliseconds whole_case{600'000};  // for all calls of a case
};

}  // namespace fieldproof::iut
