#pragma once

#include <cstdint>
#include <string_view>

#include "harness/measure/distribution.hpp"
#include "protocols/token_bus/rules.hpp"

// How a ring of reference stations comes back, counted over many random instants: something is done to it,
// quiet or together with a burst, and it is watched until it is whole again.
//
// Whole: each station that is on and wants to is in the ring, their successors make one ring, each has had
// the token since, and one of them, or nobody, holds it.
namespace fieldproof::token_bus {

enum class Disturbance : std::uint8_t {
  nothing,         // but a burst, where there is one
  token_lost,      // the next token frame is destroyed on the line
  token_doubled,   // somebody gives a second token to a station
  station_dies,    // without a word, at any instant, also while it holds the token
  station_comes,   // the one that has died
  station_leaves,  // as it is asked to
  station_joins,   // the one that has left
};
inline constexpr unsigned kDisturbances = 7;
std::string_view text_of(Disturbance disturbance);

struct RecoverySettings {
  unsigned stations = 8;  // 3 to 64
  unsigned instants = 100;
  // 75 pulses at 100 kHz, of one half bit each, begin at each instant.
  bool has_bursts = false;
  Rules rules{};
  std::uint64_t seed = 1;
  // False: who holds a token keeps it whatever it hears. Then there are two, to be found.
  bool drops_tokens = true;
};

struct RecoveryFigures {
  measure::Distribution whole_after;  // picoseconds; from the end of the disturbance and of its burst
  kernel::Duration limit{};           // what the timers allow
  std::uint64_t beyond = 0;           // not whole within it
  // Two stations hold a token.
  kernel::Duration longest_double{};
  // Data from each station to the next one, numbered. Along 500 m of cable.
  std::uint64_t delivered = 0;
  std::uint64_t delivered_twice = 0;
  std::uint64_t out_of_order = 0;

  bool is_as_allowed() const { return beyond == 0 && delivered_twice == 0 && out_of_order == 0; }
};

// The same instants and outcomes for the same settings.
RecoveryFigures recover(Disturbance disturbance, const RecoverySettings& settings);

// From the power-up of all stations until the ring is whole.
kernel::Duration time_to_form(unsigned stations, const Rules& rules);

}  // namespace fieldproof::token_bus
