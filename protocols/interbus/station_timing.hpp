#pragma once

#include <vector>

#include "harness/kernel/time.hpp"
#include "protocols/interbus/network.hpp"

// When a data cycle reaches each station, and what happens there when; on the levels that a master drives. A
// measurement of skew is held against these.
namespace fieldproof::interbus {

// From the start of the first telegram of a data cycle at a station, when it samples its inputs, to the end
// of the last octet of the status word there, when it latches its outputs.
kernel::Duration sample_to_latch(const NetworkDescription& network);

// From the master's output to the receiver of each station on the way out, in the order of the ring: what
// lies in front of it, with every branch there and back.
std::vector<kernel::Duration> arrival_delays(const NetworkDescription& network);

}  // namespace fieldproof::interbus
