#pragma once

#include <array>
#include <optional>

#include "protocols/token_bus/ring_description.hpp"

// Closed forms of a ring on a quiet line to which nobody comes and which nobody leaves.
//
// A round of the token. With
//
//   P    tokens and their way, and a response window of each station, the lowest with two
//   C_f  a datum of flow f on the line, a gap in front; of a confirmed one with its response
//   n_f  data of a flow in a round: 1 under each token; 2 of a period that two rounds fit into; else no
//   number H_i  of a station: the lesser of hold time and longest urgent datum together, and the sum of n_f
//   C_f of
//        its urgent flows
//   D    the sum of n_f C_f of the lower classes in which each n_f is a number
//   T    the longest target rotation time of the other lower classes that have data, L their longest datum
//
// it takes at most
//
//   max( P + D + sum H_i,  T + L + P + D + sum H_i - least H_i )
//
// and at most the same with all lower classes in T and L. The second one: a class of T of station i begins
// its last datum within T after its service began the time before, which was before this round; what follows
// are data of others. The numbers n_f depend on the round themselves: the first round that holds is taken.
//
// The delay of access, from the request to the end of the transmission, is at most a round and the data of
// this class of the station, where all of them are sent under one token: where they fit the hold time, in a
// lower class what a longest round leaves of its target rotation time. Else there is no bound.
namespace fieldproof::token_bus {

inline constexpr std::size_t kResponseOctets = 3;  // of response_of

struct RingBounds {
  kernel::Duration rotation{};
  std::array<std::optional<kernel::Duration>, kAccessClasses> access{};  // by RingService
};

RingBounds bounds_of(const RingDescription& ring);
// The most that a round of the token takes.
inline kernel::Duration longest_rotation(const RingDescription& ring) {
  return bounds_of(ring).rotation;
}
// The most of a round in which a transmission is lost: a token or a request is repeated.
kernel::Duration longest_disturbed_rotation(const RingDescription& ring);
// The least: nothing but tokens.
kernel::Duration least_rotation(const RingDescription& ring);

}  // namespace fieldproof::token_bus
