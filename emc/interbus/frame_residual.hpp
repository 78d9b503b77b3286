#pragma once

#include <cstdint>
#include <string>

#include "harness/kernel/time.hpp"
#include "protocols/interbus/network.hpp"

// What the frame check of a network's cycle cannot see, exactly: beside it stands what a ledger of errors
// counted. The bits are those that the check protects, with the check: loopback word, process data, check.
//
// The channel is the theory's (every bit flips with the same chance), not a burst; the worst bit-error rate
// is therefore looked for. The rate per hour is the formula of IEC 61784-3 at the bit-error rate that it lets
// be assumed, 1e-2 [both from memory, unverified].
namespace fieldproof::emc {

struct FrameResidual {
  std::string frame_check;
  unsigned bits = 0;
  double worst_ber = 0;                  // where most corrupted cycles pass
  double worst_share = 0;                // of the corrupted cycles, there
  double probability_at_one_in_100 = 0;  // that a cycle passes wrong, at a bit-error rate of 1e-2
  double rate_per_hour = 0;              // of them, in data cycles one after the other
};

// Of widths up to 16 bits: takes milliseconds.
FrameResidual frame_residual(const interbus::NetworkDescription& network, kernel::Duration cycle_time);

}  // namespace fieldproof::emc
