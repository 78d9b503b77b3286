// Which bits the disturbances of a run struck, and a plan that strikes the same ones without them.
//
// Contract: a struck bit is one that a receiver of the declared bit rate, which takes the majority of three
// samples, hears otherwise than it was sent. Where a sender drives levels that are finer than bits, as
// Manchester code does, each of them is looked at, once in its middle: half a bit that is wrong breaks the
// code. What a disturbance does beyond that (a pulse that is no bit to such a receiver) is not kept, so who
// replays the bits looks whether they do what the disturbance did.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cli/disturbances.hpp"
#include "harness/kernel/time.hpp"

namespace fieldproof::cli {

struct StruckBit {
  std::string receiver;
  kernel::Time from;           // of the disturbance
  std::uint64_t transmission;  // to the receiver, from 0 at that instant on
  std::uint64_t bit;           // or level of the transmission
  bool is_level = false;       // of a line whose levels are finer than bits: half bits of Manchester code

  friend auto operator<=>(const StruckBit&, const StruckBit&) = default;
};

// In the order in which they were struck.
using FlippedBits = std::vector<StruckBit>;

// The same disturbances, with a note in `struck` of all that they do.
conformance::Disturbances watched(conformance::Disturbances all, const std::shared_ptr<FlippedBits>& struck);

// The same for one channel of a receiver, whose transmissions are counted from its first one on.
std::unique_ptr<fault::Channel> watched(std::unique_ptr<fault::Channel> channel, std::string receiver,
                                        std::int64_t bit_rate, const std::shared_ptr<FlippedBits>& struck);

// The same for plans; stresses disturb nothing, for as long as those do.
conformance::Disturbances without_stresses(conformance::Disturbances all);

// The text of a plan with these bits instead of all disturbances of `plan`, which is the text of one, or
// empty.
std::string plan_of(std::span<const StruckBit> struck, const std::string& plan);

}  // namespace fieldproof::cli
