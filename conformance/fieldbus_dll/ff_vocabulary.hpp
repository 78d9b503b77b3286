#pragma once

#include <cstdint>
#include <vector>

#include "conformance/sequence.hpp"

// What sequences for a basic device of Foundation Fieldbus are made of: words, their numbers, what leads into
// its states, and the settings that they may begin with.
namespace fieldproof::conformance {

enum class FfWord : std::uint8_t {
  token,
  compel,
  probe,
  other,
  data,
  published,
  activation,
  noise,
  submit,
  write,
  supply,
  one,
  wait,
  framed,
  checked,
  control,
  ended,
  busy,
  room,
  many,
  ask,
  beside,
  received,
  in_front,
  within,
  meanwhile,
  idle
};

// Of "first" of data: those of the DT1 before.
inline constexpr std::int64_t kSameAgain = 4;
// Of "ask": the request for which there is a call; what is greater there is not, and what is less is a
// request of a device that ends within its address.
inline constexpr std::int64_t kOrderOfAMaster = 3;

// What a device publishes and has subscribed to besides two buffers each.
inline constexpr unsigned kMorePublished = 3;
inline constexpr unsigned kMoreSubscribed = 8;
inline constexpr unsigned kFirstOfMore = 8;  // behind the first selector

SequenceVocabulary ff_device_vocabulary();
std::vector<std::vector<NamedCommand>> states_of_a_device();

}  // namespace fieldproof::conformance
