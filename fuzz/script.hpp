#pragma once

#include <cstddef>
#include <cstdint>

#include "fuzz/octet_reader.hpp"
#include "harness/line/waveform.hpp"

// What the scripts of several targets have in common. The stored inputs rest on how many octets each of these
// takes and what it makes of them.
namespace fieldproof::fuzz {

// What a step begins with: what comes, in the low bits of an octet; with its highest bit set one octet
// follows that says which level is flipped.
struct StepChoice {
  unsigned kind = 0;      // below the number of kinds that the target has
  std::uint8_t flip = 0;  // 0: none
};

inline StepChoice read_choice(OctetReader& input, unsigned kinds) {
  const std::uint8_t choice = input.octet();
  const std::uint8_t flip = (choice & 0x80) != 0 ? input.octet() : std::uint8_t{0};
  return {(choice & 0x7FU) % kinds, flip};
}

// Level number `flip`, counted around; none for 0, nor where there are none.
inline void flip_level(line::Levels& levels, std::uint8_t flip) {
  if (flip != 0 && !levels.empty()) levels.flip(flip % levels.size());
}

// 31.25 to 8000 kHz, in steps of the lowest.
inline std::int64_t read_rate(OctetReader& input) {
  return (std::int64_t{input.octet()} + 1) * 31'250;
}

// 8 to 256 levels as they lie in the input, fewer at its end.
inline void append_levels(OctetReader& input, line::Levels& levels) {
  for (const std::uint8_t octet : input.take(input.octet() % 32U + 1)) levels.append(octet, 8);
}

// A world made by the first octet, some steps of the script, and what must hold when the line is clean again.
// Gives back what LLVMFuzzerTestOneInput does: inputs that are too long are none.
template <typename World>
int play_script(const std::uint8_t* data, std::size_t size, unsigned most_steps) {
  constexpr std::size_t kLargestInput = 512;
  if (size > kLargestInput) return -1;
  OctetReader input(data, size);
  World world(input.octet());
  for (unsigned steps = 0; steps < most_steps && !input.is_empty(); ++steps) world.step(input);
  world.recover();
  return 0;
}

}  // namespace fieldproof::fuzz
