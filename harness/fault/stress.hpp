#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "harness/fault/channel.hpp"
#include "harness/kernel/random.hpp"
#include "harness/kernel/time.hpp"
#include "harness/trace/trace.hpp"

// A stress disturbs the line of a receiver for a while, as a burst generator does: nobody says which levels.
// Test cases that need one ask for its channel and know no more of where it comes from; the generators of
// IEC 61000-4-4 make them, and so can a user's own model of an installation.
//
// Contract: a channel is a function of stress and place: equal streams give equal disturbances. It reports
// what it changed as faults of the trace.
namespace fieldproof::fault {

struct StressPlace {
  std::int64_t bit_rate;
  kernel::Time from;      // the line is quiet before, and the stress begins here
  kernel::Random random;  // is split, not drawn from
  trace::Trace& trace;
  trace::Channel channel;  // of its faults
};

struct Stress {
  std::string name;           // "bursts of 5 kHz, +, level 4 (2000 V), profile A"
  kernel::Duration duration;  // at most; quiet behind
  // Null: the line stays as it is.
  std::function<std::unique_ptr<Channel>(const StressPlace&)> make_channel;
};

}  // namespace fieldproof::fault
