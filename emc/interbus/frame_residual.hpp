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

// That a cycle arrives wrong at one receiver and passes, where each bit flips with this probability. An upper
// bound but for what takes two flips outside of the data, as a receiver also looks at framing and status, and
// a master at the number of telegrams and at the loopback word.
//
// All but the code words rests on this project's reading of the header [own], whose levels no check protects:
// nothing but the control level tells a slave where the data end.
struct UndetectedCycle {
  double by_code_word = 0;   // the flips are a code word of the frame check
  double by_shift = 0;       // one flipped control level moves the end of the data, see PassingShifts
  double by_misframing = 0;  // one flipped level loses or inserts an octet, and the check fits by chance

  double any() const { return by_code_word + by_shift + by_misframing; }
};
UndetectedCycle undetected_cycle(const interbus::NetworkDescription& network, double flip_probability);

// What share of cycles with one flipped control level passes a slave's check.
struct PassingShifts {
  // Of the last data telegram: its octet counts as the first of the check, and fits when it happens to be
  // what the check of the octets before it begins with.
  double early_check = 0;
  // Of the first check telegram: its octet counts as data, and what follows is the check of that. The status
  // word is whole only where end telegrams follow.
  double late_check = 0;
};
PassingShifts passing_shifts(const interbus::NetworkDescription& network);

// How well a count goes with a theory: the probability of so many events or more where `expected` come on
// average (Poisson). A small one refutes that no more are to be expected.
double chance_of_at_least(std::uint64_t counted, double expected);

}  // namespace fieldproof::emc
