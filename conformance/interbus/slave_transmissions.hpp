#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "conformance/interbus/slave_bench.hpp"

// Right data cycles that come to a slave in transmissions of a shape of their own: cut, in three, with a
// glitch between their telegrams; and what comes back to it from after its outgoing interfaces, not as a
// sender of the bench would drive it. Each leaves what was driven in the views.
namespace fieldproof::conformance {

// As many words as the slave has: these two in turn, from the third on each another one.
std::vector<std::uint16_t> words_in_turn(const SlaveBench& bench, std::int64_t even, std::int64_t odd);

// A place in a data cycle: a telegram, from 0, and one of its levels. Telegrams are counted round.
struct CutPlace {
  std::int64_t telegram = 0;
  std::int64_t level = 0;
};

// The transmission ends in front of that level, and nothing follows: the rest is idle. With `loses_supply`
// the supply goes when it ends, for a millisecond.
void drive_cut_cycle(SlaveBench& bench, std::int64_t word, CutPlace at, bool loses_supply);
// In three transmissions without a gap: the second one has so many levels.
void drive_in_three(SlaveBench& bench, std::int64_t word, CutPlace at, std::int64_t levels);
// In two without a gap, the first of which ends with a telegram whose stop level is missing.
void drive_cut_at_missing_stop(SlaveBench& bench, std::int64_t word, std::int64_t telegram);
// After that telegram a low pulse of so many eighths of a bit.
void drive_glitch_within(SlaveBench& bench, std::int64_t word, std::int64_t telegram, std::int64_t eighths);

// A low pulse of so many eighths of a bit comes back.
void return_glitch(SlaveBench& bench, bool on_branch, std::int64_t eighths);
// Data telegrams whose low pulses are so many twentieths of a bit longer, at another bit rate.
void return_pulses(SlaveBench& bench, bool on_branch, std::int64_t octet, std::int64_t longer,
                   std::int64_t per_mille);

}  // namespace fieldproof::conformance
