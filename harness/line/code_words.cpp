#include "harness/line/code_words.hpp"

#include <algorithm>

#include "harness/kernel/check.hpp"

namespace fieldproof::line {
namespace {

std::uint64_t times_x(const FrameCheckParameters& p, std::uint64_t value) {
  const std::uint64_t top = std::uint64_t{1} << (p.width - 1);
  const std::uint64_t kept = value & (top - 1);
  return (kept << 1) ^ ((value & top) != 0 ? static_cast<std::uint64_t>(p.poly) : 0);
}

std::uint64_t multiply(const FrameCheckParameters& p, std::uint64_t a, std::uint64_t b) {
  std::uint64_t product = 0;
  for (unsigned bit = p.width; bit-- > 0;) {
    product = times_x(p, product) ^ (((b >> bit) & 1) != 0 ? a : 0);
  }
  return product;
}

// What a flip of each position adds to the remainder, first position of the line first.
std::vector<std::uint64_t> syndromes(const FrameCheckParameters& p, unsigned codeword_bits) {
  FIELDPROOF_CHECK(p.width <= 64, "code words are only listed for checks of at most 64 bits");
  std::vector<std::uint64_t> of_position(codeword_bits);
  std::uint64_t power = 1;
  for (unsigned position = codeword_bits; position-- > 0;) {
    of_position[position] = power;
    power = times_x(p, power);
  }
  return of_position;
}

// Appends the sums of all sets of `size` values from position `from` on, each added to `sum`.
void append_sums(const std::vector<std::uint64_t>& values, unsigned size, std::size_t from, std::uint64_t sum,
                 std::vector<std::uint64_t>& sums) {
  if (size == 0) {
    sums.push_back(sum);
    return;
  }
  for (std::size_t at = from; at + size <= values.size(); ++at) {
    append_sums(values, size - 1, at + 1, sum ^ values[at], sums);
  }
}

std::vector<std::uint64_t> sorted_sums(const std::vector<std::uint64_t>& values, unsigned size) {
  std::vector<std::uint64_t> sums;
  append_sums(values, size, 0, 0, sums);
  std::sort(sums.begin(), sums.end());
  sums.erase(std::unique(sums.begin(), sums.end()), sums.end());
  return sums;
}

// Whether a ^ b == 1 for some a and b; both ascend. Values that differ in the lowest bit alone are
// neighbours, so the two lists are walked side by side.
bool some_pair_differs_by_one(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
  auto at = b.begin();
  for (const std::uint64_t value : a) {
    while (at != b.end() && (*at | 1) < (value | 1)) ++at;
    for (auto look = at; look != b.end() && (*look | 1) == (value | 1); ++look) {
      if (*look != value) return true;
    }
  }
  return false;
}

struct Pair {
  std::uint64_t sum;
  std::uint32_t first;
  std::uint32_t second;
};

std::vector<Pair> sorted_pairs(const std::vector<std::uint64_t>& of_position) {
  const auto count = static_cast<std::uint32_t>(of_position.size());
  std::vector<Pair> pairs;
  pairs.reserve(std::size_t{count} * (count > 0 ? count - 1 : 0) / 2);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t j = i + 1; j < count; ++j) pairs.push_back({of_position[i] ^ of_position[j], i, j});
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.sum < b.sum; });
  return pairs;
}

}  // namespace

std::vector<FourBits> weight_four_code_words(const FrameCheckParameters& parameters, unsigned codeword_bits) {
  const std::vector<Pair> pairs = sorted_pairs(syndromes(parameters, codeword_bits));
  std::vector<FourBits> found;
  for (auto group = pairs.begin(); group != pairs.end();) {
    const auto end = std::find_if(group, pairs.end(), [&](const Pair& p) { return p.sum != group->sum; });
    // Each set of four splits into two pairs in three ways, all with equal sums: the one whose pairs lie
    // after each other counts.
    for (auto low = group; low != end; ++low) {
      for (auto high = group; high != end; ++high) {
        if (low->second < high->first) {
          found.push_back({low->first, low->second, high->first, high->second});
        }
      }
    }
    group = end;
  }
  std::sort(found.begin(), found.end());
  return found;
}

bool has_code_word(const FrameCheckParameters& parameters, unsigned codeword_bits, unsigned weight) {
  FIELDPROOF_CHECK(weight >= 1, "a code word of no weight at all always exists");
  if (codeword_bits == 0) return false;
  // A code word may be shifted towards the end until its last bit is set: x divides no polynomial of a check.
  // So the last position is always part of it, and two halves of the others must add up to its remainder, 1.
  std::vector<std::uint64_t> others = syndromes(parameters, codeword_bits);
  others.pop_back();
  // Halves that share a position only mean a code word of less weight.
  for (unsigned w = 2; w <= weight; ++w) {
    const std::vector<std::uint64_t> smaller = sorted_sums(others, (w - 1) / 2);
    const std::vector<std::uint64_t> larger = sorted_sums(others, w - 1 - (w - 1) / 2);
    if (some_pair_differs_by_one(smaller, larger)) return true;
  }
  return false;
}

std::uint64_t power_of_x(const FrameCheckParameters& parameters, std::uint64_t exponent) {
  FIELDPROOF_CHECK(parameters.width <= 64, "powers of x are only computed for checks of at most 64 bits");
  std::uint64_t power = 1;
  std::uint64_t square = 2;
  for (; exponent > 0; exponent >>= 1) {
    if ((exponent & 1) != 0) power = multiply(parameters, power, square);
    square = multiply(parameters, square, square);
  }
  return power;
}

}  // namespace fieldproof::line
