#pragma once

#include <cstdint>
#include <string>

#include "harness/network/network.hpp"

// What the check of a network's frame cannot see, exactly: beside it stands what error statistics counted.
//
// The channel is the theory's (every bit flips with the same chance), not a burst; the worst bit-error rate
// is therefore looked for. The rate per hour is the formula of IEC 61784-3 at the bit-error rate that it lets
// be assumed, 1e-2 [both from memory, unverified].
namespace fieldproof::emc {

struct FrameResidual {
  std::string frame_check;
  unsigned bits = 0;
  double worst_ber = 0;                  // where most corrupted frames pass
  double worst_share = 0;                // of the corrupted frames, there
  double probability_at_one_in_100 = 0;  // that a frame passes wrong, at a bit-error rate of 1e-2
  double rate_per_hour = 0;              // of them, in frames one after the other; 0 without a distance
};

// Of widths up to 16 bits: takes milliseconds.
FrameResidual frame_residual(const network::ProtectedFrame& frame);

// The share of corrupted frames that pass where each bit flips with this chance, exact.
double undetected_share_at(const network::ProtectedFrame& frame, double ber);

// How well a count goes with a theory: the probability of so many events or more where `expected` come on
// average (Poisson). A small one refutes that no more are to be expected.
double chance_of_at_least(std::uint64_t counted, double expected);

}  // namespace fieldproof::emc
