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

// That a cycle arrives wrong at one receiver and passes, where each bit flips with this probability: an upper
// bound, as a receiver also looks at framing and status, and a master at the loopback word.
struct UndetectedCycle {
  // The flips are a code word of the frame check.
  double by_code_word = 0;
  // One flip, in the control level of the last data telegram, and a slave takes that octet for the first of
  // the check: all words move by an octet. The check fits when the octet happens to be what the check of
  // those before it begins with, 1 time in 256; nothing else tells a slave how long a cycle is. [derived from
  // this project's reading of the header, whose bits no check protects; the master counts telegrams]
  double by_shift = 0;

  double any() const { return by_code_word + by_shift; }
};
UndetectedCycle undetected_cycle(const interbus::NetworkDescription& network, double flip_probability);

// Of all last octets of a cycle's data, the share with which such a shift passes a slave's check.
double share_of_passing_shifts(const interbus::NetworkDescription& network);

// How well a count goes with a theory: the probability of so many events or more where `expected` come on
// average (Poisson). A small one refutes that no more are to be expected.
double chance_of_at_least(std::uint64_t counted, double expected);

}  // namespace fieldproof::emc
