#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

// Wrong bits of octets, for cases about a block check.
namespace fieldproof::conformance {

inline void invert(std::span<std::uint8_t> octets, unsigned bit) {
  octets[bit / 8] = static_cast<std::uint8_t>(octets[bit / 8] ^ (1U << (bit % 8)));
}

// All pairs of bits of so many octets: first those in one column, which an exclusive or cannot see, then the
// others, in an order in which the first ones are of all kinds.
inline std::vector<std::pair<unsigned, unsigned>> bit_pairs(unsigned octets) {
  std::vector<std::pair<unsigned, unsigned>> pairs;
  std::vector<std::pair<unsigned, unsigned>> others;
  for (unsigned first = 0; first < 8 * octets; ++first) {
    for (unsigned second = first + 1; second < 8 * octets; ++second) {
      ((second - first) % 8 == 0 ? pairs : others).emplace_back(first, second);
    }
  }
  constexpr std::size_t kStride = 11;  // divides the number of others for no frame of the bus
  for (std::size_t n = 0; n < others.size(); ++n) pairs.push_back(others[n * kStride % others.size()]);
  return pairs;
}

}  // namespace fieldproof::conformance
