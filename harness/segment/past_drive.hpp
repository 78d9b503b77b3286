#pragma once

#include <string>

#include "harness/kernel/time.hpp"
#include "harness/line/waveform.hpp"

// A station drives a line now or later. One that does not may be under test, so it is blamed, and no broken
// promise of ours is.
namespace fieldproof::segment {

// Throws kernel::Error(implementation) with the line and both instants.
[[noreturn]] void refuse_past_drive(const std::string& line, kernel::Time start, kernel::Time now);

inline void expect_not_past(const std::string& line, const line::Waveform& wave, kernel::Time now) {
  if (wave.start < now) refuse_past_drive(line, wave.start, now);
}

}  // namespace fieldproof::segment
