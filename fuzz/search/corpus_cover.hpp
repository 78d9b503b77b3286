#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Which inputs of many are enough to pass what all of them pass.
namespace fieldproof::fuzz {

struct CoveringInput {
  std::vector<std::uint8_t> octets;
  std::vector<std::uint64_t> features;  // rising
};

// Their places in `inputs`, rising. Each of them passes something that no other of them does. Short inputs
// are preferred; the order of `inputs` decides nothing but which of two equal ones it is.
std::vector<std::size_t> smallest_cover(std::span<const CoveringInput> inputs);

}  // namespace fieldproof::fuzz
