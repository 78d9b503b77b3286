#pragma once

#include "protocols/interbus/network.hpp"

// What the check of an INTERBUS cycle lets pass on a channel on which every bit flips with the same chance.
namespace fieldproof::emc {

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

}  // namespace fieldproof::emc
