#include "harness/measure/edge_code.hpp"

#include "harness/kernel/check.hpp"

namespace fieldproof::measure {
namespace {

// Odd, so that it has an inverse; close to 2^16 divided by the golden ratio, so that neighbours lie far
// apart.
constexpr std::uint64_t kFactor = 0x9E37;

constexpr std::uint64_t inverse_of(std::uint64_t odd) {
  std::uint64_t inverse = odd;  // right in three bits, and twice as many with each step
  for (int step = 0; step < 4; ++step) inverse *= 2 - odd * inverse;
  return inverse & 0xFFFF;
}
constexpr std::uint64_t kInverse = inverse_of(kFactor);
static_assert((kFactor * kInverse & 0xFFFF) == 1);

}  // namespace

EdgeCode::EdgeCode(unsigned bits) : mask_((std::uint64_t{1} << bits) - 1) {
  FIELDPROOF_CHECK(bits >= 1 && bits <= 16, "a word of an edge code has 1 to 16 bits");
}

std::uint16_t EdgeCode::word(std::uint64_t edges) const {
  return static_cast<std::uint16_t>(edges * kFactor & mask_);
}

std::optional<std::uint64_t> EdgeCode::edges(std::uint16_t word, std::uint64_t newest) const {
  if ((word & ~mask_) != 0) return std::nullopt;
  const std::uint64_t number = word * kInverse & mask_;
  const std::uint64_t behind = (newest - number) & mask_;
  if (behind > newest) return std::nullopt;
  return newest - behind;
}

}  // namespace fieldproof::measure
