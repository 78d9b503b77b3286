#pragma once

#include <cstdint>
#include <vector>

#include "conformance/sequence.hpp"

// The words of sequences for a slave; what they do to it and to its twins: slave_acts.hpp.
namespace fieldproof::conformance {

// In the order of the vocabulary.
enum class SlaveWord : std::uint8_t {
  data,
  id,
  telegrams,
  status,
  inputs,
  plugs,
  periphery,
  returns,
  silence,
  kept_alive,
  power,
  glitch,
  good,
  no_stop,
  rate,
  pulses,
  parts,
  right_id,
  clock,
  cut,
  lost_in_a_telegram,
  three_parts,
  cut_without_stop,
  glitch_within,
  returned_glitch,
  returned_pulses,
  kept_alive_without_stop,
};

// What the number "orders" consists of, whatever the places of these in a control word are.
namespace slave_orders {
inline constexpr std::int64_t kRemoteOff = 1;
inline constexpr std::int64_t kBranchOff = 2;
inline constexpr std::int64_t kReset = 4;
inline constexpr std::int64_t kAcknowledge = 8;
}  // namespace slave_orders

// Octets of a cycle in front of the slave's own: loopback word, and a word for a station after each
// interface.
inline constexpr std::size_t kFrontOfSlave = 6;

std::vector<SequenceWord> slave_words();

}  // namespace fieldproof::conformance
