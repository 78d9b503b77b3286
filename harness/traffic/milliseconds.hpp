#pragma once

#include "harness/kernel/time.hpp"

// The unit of the paper's delays and rates.
namespace fieldproof::traffic {

inline constexpr double kPicosecondsPerMs = 1e9;

inline double ms(kernel::Duration duration) {
  return static_cast<double>(duration.count()) / kPicosecondsPerMs;
}

}  // namespace fieldproof::traffic
