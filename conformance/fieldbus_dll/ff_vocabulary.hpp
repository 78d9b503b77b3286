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
  many
};

// Of "first" of data: those of the DT1 before.
inline constexpr std::int64_t kSameAgain = 4;

SequenceVocabulary ff_device_vocabulary();
std::vector<std::vector<NamedCommand>> states_of_a_device();

}  // namespace fieldproof::conformance
