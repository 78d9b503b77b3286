#pragma once

#include <cstdint>
#include <vector>

#include "conformance/sequence.hpp"

// What sequences for a data link entity of ISA-D are made of: words, their numbers, what leads into its
// states, and the settings that they may begin with.
namespace fieldproof::conformance {

enum class IsaWord : std::uint8_t {
  single,
  sequence,
  compel,
  other,
  data,
  reply,
  noise,
  submit,
  peer,
  supply,
  one,
  wait,
  framed,
  received,
  checked,
  control,
  late,
  answered
};

// What the tester does after a CD of the station.
enum class Peer : std::uint8_t {
  silent,
  replies,
  replies_empty,
  replies_without_final,
  stranger_replies,
  replies_to_stranger,
  sends_data,
  stranger_sends,
  compels,
  delegates,
  takes_back,
  sends_none,
  makes_noise
};

SequenceVocabulary isa_dle_vocabulary();
std::vector<std::vector<NamedCommand>> states_of_an_entity();

}  // namespace fieldproof::conformance
