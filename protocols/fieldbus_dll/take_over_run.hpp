#pragma once

#include <cstdint>

#include "harness/kernel/time.hpp"
#include "protocols/fieldbus_dll/ff_link.hpp"

// A link of Foundation Fieldbus whose scheduler dies at a random instant: who takes over, when, and what of
// the schedule is lost.
//
// Three link masters (10, the scheduler; 11 and 14) and three publishers (20, 21, 22), each compelled twice
// in a macrocycle of 500 ms, with the rules of the reference. From its death on nothing that
// the scheduler drives reaches the line; a frame that it has begun is sent to its end. Each receiver loses
// each frame with the same probability; that somebody is active is heard all the same.
namespace fieldproof::fieldbus_dll {

struct TakeOverSetting {
  std::uint64_t seed = 1;
  std::int64_t bit_rate = 31'250;
  FfDisturb disturb{};
};

struct TakeOver {
  std::uint8_t claimer = 0;     // 0: nobody has claimed the link
  unsigned claims = 0;          // CL in all
  kernel::Duration silence{};   // from the last activity to the first CL
  unsigned foreign_frames = 0;  // only a scheduler sends, by another than the one that there is
  unsigned due_meanwhile = 0;   // items of the schedule, from the death until the claimer may compel
  unsigned not_compelled = 0;   // of those and of all that were due in the two macrocycles behind
  unsigned not_published = 0;   // what was compelled of these, and not answered with its data
};

// What V(ST) x V(TN) and V(MICD) say about `silence`, for link master 11.
kernel::Duration take_over_silence(std::int64_t bit_rate = 31'250);

TakeOver run_take_over(const TakeOverSetting& setting);

}  // namespace fieldproof::fieldbus_dll
