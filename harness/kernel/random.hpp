// Seeded random numbers that are the same on every machine and under every compiler.
//
// The generator is xoshiro256** (Blackman and Vigna), its state filled by SplitMix64 (Steele, Lea, Flood);
// both are in the public domain. All derived draws (below, uniform, geometric ...) are computed here with
// integer arithmetic or with plain additions, multiplications and divisions of doubles, never with a function
// of the C library or a standard distribution, because those may differ from machine to machine.
//
// Contract: a stream is a value; copying it copies its position. `split` gives a child stream that depends
// only on the seed of its parent and on the label or index, not on how much was drawn from the parent; equal
// labels give equal children. Not for cryptography. Periods: 2^256 - 1 draws.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>

namespace fieldproof::kernel {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_{}, seed_(seed) {
    for (std::uint64_t& word : state_) word = scramble(seed += kGolden);
  }

  // The seed that this stream was made from (a child has its own).
  std::uint64_t seed() const { return seed_; }

  // Child streams. A label and an index never name the same child by construction of the mixing.
  Random split(std::string_view label) const;
  Random split(std::uint64_t index) const { return Random(child_seed(branch_seed(seed_, kIndexed), index)); }

  // 64 uniform bits.
  std::uint64_t next() {
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  // Uniform in [0, bound), without bias; bound > 0.
  std::uint64_t below(std::uint64_t bound) {
    // Multiply-shift: the high half of a 128-bit product is the result; the few low halves that would favour
    // some results are drawn again.
    Wide product = static_cast<Wide>(next()) * bound;
    if (static_cast<std::uint64_t>(product) < bound) {
      const std::uint64_t unfair = (0 - bound) % bound;
      while (static_cast<std::uint64_t>(product) < unfair) product = static_cast<Wide>(next()) * bound;
    }
    return static_cast<std::uint64_t>(product >> 64);
  }

  // Uniform in [low, high], both ends included; low <= high. The whole range of the type is allowed.
  std::int64_t between(std::int64_t low, std::int64_t high) {
    const std::uint64_t span = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
    const std::uint64_t offset = span == ~std::uint64_t{0} ? next() : below(span + 1);
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + offset);
  }

  // Uniform in [0, 1) in steps of 2^-53.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

  // True with probability p (0 never, 1 always); always takes one draw.
  bool chance(double p) { return uniform() < p; }

  // Number of failures before the first hit of independent trials that each hit with probability p: 0 for
  // p >= 1, the largest 64-bit number for p <= 0. Costs one draw and two logarithms whatever p is; a loop
  // that keeps p should keep a GeometricSkip, which saves one of the two.
  std::uint64_t geometric(double p);

  // All orders equally likely (Fisher and Yates, from the back).
  template <typename Range>
  void shuffle(Range& range) {
    const auto first = std::begin(range);
    for (auto left = static_cast<std::uint64_t>(std::size(range)); left > 1; --left) {
      using std::swap;
      using Step = typename std::iterator_traits<decltype(std::begin(range))>::difference_type;
      swap(first[static_cast<Step>(left - 1)], first[static_cast<Step>(below(left))]);
    }
  }

 private:
  friend class RandomChildren;
  __extension__ using Wide = unsigned __int128;

  // SplitMix64: a counter in steps of the golden ratio, each value scrambled.
  static constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15;

  static constexpr std::uint64_t scramble(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
    return x ^ (x >> 31);
  }

  // The two ways to name a child start from different constants, so that no index meets a label by design.
  static constexpr std::uint64_t kLabelled = 0x6C6162656C6C6564;
  static constexpr std::uint64_t kIndexed = 0x696E646578656421;

  // All children of one kind have the branch in common.
  static constexpr std::uint64_t branch_seed(std::uint64_t parent, std::uint64_t kind) {
    return scramble(scramble(parent + kGolden) ^ kind);
  }
  static constexpr std::uint64_t child_seed(std::uint64_t branch, std::uint64_t name) {
    return scramble(branch + scramble(name + kGolden));
  }

  std::array<std::uint64_t, 4> state_;
  std::uint64_t seed_;
};

// The children of one stream by index, for a loop that asks for many of them: each is that of `split`.
class RandomChildren {
 public:
  explicit RandomChildren(const Random& parent)
      : branch_(Random::branch_seed(parent.seed(), Random::kIndexed)) {}

  Random operator[](std::uint64_t index) const { return Random(Random::child_seed(branch_, index)); }

 private:
  std::uint64_t branch_;
};

// Geometric draws for one fixed probability: how many units pass untouched before the next hit. Walking a
// line of bits with bit-error probability 1e-7 this way costs one draw per ten million bits.
//
// By inversion: floor(ln(U) / ln(1 - p)) with U uniform in (0, 1] in steps of 2^-53, so skips beyond
// 36.7 / p do not occur (their total probability is 2^-53).
class GeometricSkip {
 public:
  explicit GeometricSkip(double p);

  std::uint64_t operator()(Random& random) const;

 private:
  // 1 / ln(1 - p): 0 for a sure hit, -infinity where no hit ever comes.
  double inverse_log_of_miss_;
};

// Natural logarithm of x > 0 (normal numbers) to a few units in the last place, the same bits everywhere.
double portable_log(double x);

// ln(1 - p) for 0 <= p < 1, exact to a few units in the last place for tiny p as well.
double portable_log_of_complement(double p);

}  // namespace fieldproof::kernel
