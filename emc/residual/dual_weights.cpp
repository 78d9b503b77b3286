#include "emc/residual/dual_weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <numeric>

#include "emc/residual/register_cycles.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

constexpr Polynomial kXPlusOne = 3;
constexpr std::size_t kWordBits = 64;
constexpr std::size_t kBlockWords = 4096;
constexpr unsigned kNibbles = 256;  // four bits that enter the window and four that leave it
// From so many windows on, counting four at a time pays for unfolding them at the end.
constexpr std::uint64_t kManyWindows = std::uint64_t{1} << 22;

struct Steps {
  std::array<std::int8_t, 4> before;  // the weight at each of four windows, less that at the first
  std::int8_t after;
};

constexpr std::array<Steps, kNibbles> all_steps() {
  std::array<Steps, kNibbles> all{};
  for (unsigned key = 0; key < kNibbles; ++key) {
    int weight = 0;
    for (unsigned bit = 0; bit < 4; ++bit) {
      all.at(key).before.at(bit) = static_cast<std::int8_t>(weight);
      weight += static_cast<int>((key >> (4 + bit)) & 1) - static_cast<int>((key >> bit) & 1);
    }
    all.at(key).after = static_cast<std::int8_t>(weight);
  }
  return all;
}

constexpr std::array<Steps, kNibbles> kSteps = all_steps();

constexpr std::array<std::int8_t, kNibbles> all_gains() {
  std::array<std::int8_t, kNibbles> gains{};
  for (unsigned key = 0; key < kNibbles; ++key) gains.at(key) = kSteps.at(key).after;
  return gains;
}

constexpr std::array<std::int8_t, kNibbles> kGains = all_gains();

// Weighs every window of `bits` bits on the cycles that it is given.
class WindowWalk {
 public:
  WindowWalk(Polynomial polynomial, unsigned bits, bool has_many_windows, const DualProgress& on_progress)
      : polynomial_(polynomial),
        degree_(static_cast<std::size_t>(std::bit_width(polynomial)) - 1),
        bits_(bits),
        count_(bits + 1),
        on_progress_(on_progress) {
    for (std::size_t k = 0; k < degree_; ++k) {
      if (((polynomial >> k) & 1) != 0) taps_.push_back(k);
    }
    if (has_many_windows) by_nibble_.resize((std::size_t{bits} + 1) * kNibbles);
  }

  void walk(const RegisterCycle& cycle) {
    const std::size_t block =
        std::min<std::uint64_t>(kBlockWords, (cycle.length + kWordBits - 1) / kWordBits);
    begin(cycle.start, block + kept_words());
    std::uint64_t left = cycle.length;
    while (left > 0) {
      const std::uint64_t now = std::min<std::uint64_t>(left, block * kWordBits);
      weigh(now);
      left -= now;
      if (left > 0) advance(block);
    }
  }

  std::vector<std::uint64_t> take_counts() {
    for (std::size_t at = 0; at < by_nibble_.size(); ++at) {
      if (by_nibble_[at] == 0) continue;
      const std::size_t weight = at / kNibbles;
      for (const std::int8_t step : kSteps[at % kNibbles].before) {
        count_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(weight) + step)] += by_nibble_[at];
      }
    }
    by_nibble_.clear();
    return std::move(count_);
  }

 private:
  // Words beyond a block that its windows reach, and that the next block is made from.
  std::size_t kept_words() const { return std::max<std::size_t>(bits_ / kWordBits + 2, degree_); }

  void begin(std::uint32_t start, std::size_t size) {
    words_.assign(size, 0);
    std::uint64_t at = start;
    for (std::size_t i = 0; i < degree_ * kWordBits; ++i, at = shifted(at, polynomial_)) {
      words_[i / kWordBits] |= (at & 1) << (i % kWordBits);
    }
    generate_from(degree_);
    weight_ = 0;
    for (std::size_t i = 0; i < bits_; ++i) weight_ += static_cast<std::ptrdiff_t>(bit(i));
  }

  // p(x)^64 = p(x^64) over GF(2): words follow each other by the rule of the bits.
  void generate_from(std::size_t first) {
    for (std::size_t i = first; i < words_.size(); ++i) {
      std::uint64_t word = 0;
      for (const std::size_t tap : taps_) word ^= words_[i - degree_ + tap];
      words_[i] = word;
    }
  }

  void advance(std::size_t block) {
    std::copy(words_.begin() + static_cast<std::ptrdiff_t>(block), words_.end(), words_.begin());
    generate_from(words_.size() - block);
  }

  std::uint64_t bit(std::size_t i) const { return (words_[i / kWordBits] >> (i % kWordBits)) & 1; }

  // The 64 bits that enter while word `i` leaves.
  std::uint64_t entering(std::size_t i) const {
    const std::size_t first = i + bits_ / kWordBits;
    const unsigned shift = bits_ % kWordBits;
    if (shift == 0) return words_[first];
    return (words_[first] >> shift) | (words_[first + 1] << (kWordBits - shift));
  }

  void weigh(std::uint64_t windows) {
    const std::size_t whole = by_nibble_.empty() ? 0 : static_cast<std::size_t>(windows / kWordBits);
    weigh_words(whole);
    for (std::size_t i = whole * kWordBits; i < windows; ++i) {
      ++count_[static_cast<std::size_t>(weight_)];
      weight_ += static_cast<std::ptrdiff_t>(bit(i + bits_)) - static_cast<std::ptrdiff_t>(bit(i));
    }
    done_ += windows;
    if (on_progress_) on_progress_(done_);
  }

  // The weight of the first of four windows and the eight bits that enter and leave tell all four: one count
  // for four windows.
  void weigh_words(std::size_t words) {
    std::ptrdiff_t weight = weight_;
    std::uint32_t* const by_nibble = by_nibble_.data();
    for (std::size_t i = 0; i < words; ++i) {
      const std::uint64_t out = words_[i];
      const std::uint64_t in = entering(i);
      // Octets whose low nibble leaves and whose high nibble enters, for even and odd nibbles.
      constexpr std::uint64_t kLow = 0x0F0F'0F0F'0F0F'0F0F;
      std::uint64_t even = (out & kLow) | ((in & kLow) << 4);
      std::uint64_t odd = ((out >> 4) & kLow) | (in & ~kLow);
      for (unsigned octet = 0; octet < 8; ++octet, even >>= 8, odd >>= 8) {
        ++by_nibble[weight * std::ptrdiff_t{kNibbles} + static_cast<std::ptrdiff_t>(even & 0xFF)];
        weight += kGains[even & 0xFF];
        ++by_nibble[weight * std::ptrdiff_t{kNibbles} + static_cast<std::ptrdiff_t>(odd & 0xFF)];
        weight += kGains[odd & 0xFF];
      }
    }
    weight_ = weight;
  }

  Polynomial polynomial_;
  std::size_t degree_;
  std::size_t bits_;
  std::vector<std::size_t> taps_;
  std::vector<std::uint64_t> count_;
  std::vector<std::uint32_t> by_nibble_;  // no count exceeds 2^30: one for four of at most 2^32 windows
  std::vector<std::uint64_t> words_;
  std::ptrdiff_t weight_ = 0;
  std::uint64_t done_ = 0;
  const DualProgress& on_progress_;
};

Polynomial polynomial_of(const line::FrameCheckParameters& parameters) {
  return (Polynomial{1} << parameters.width) | static_cast<Polynomial>(parameters.poly);
}

// A factor x + 1 adds to each sequence its complement, and nothing else: the other factors are walked alone.
struct Walk {
  Polynomial polynomial;
  bool has_complements;
};

Walk walk_for(Polynomial whole) {
  const std::vector<PrimePower> factors = factors_of(whole);
  if (factors.front() != PrimePower{kXPlusOne, 1} || factors.size() == 1) return {whole, false};
  Polynomial rest = 0;
  // Dividing by x + 1 is summing up from the lowest coefficient.
  for (unsigned k = 0; k + 1 < static_cast<unsigned>(std::bit_width(whole)); ++k) {
    const Polynomial below = k == 0 ? 0 : (rest >> (k - 1)) & 1;
    rest |= (((whole >> k) & 1) ^ below) << k;
  }
  return {rest, true};
}

std::uint64_t sequences_of(Polynomial polynomial) {
  return std::uint64_t{1} << (std::bit_width(polynomial) - 1);
}

void check_limits(const line::FrameCheckParameters& parameters, unsigned bits) {
  if (parameters.width > kWidestCheck) {
    throw kernel::Error(
        kernel::ErrorKind::usage,
        fmt::format("{} has {} check bits; undetected errors are computed for checks of at most {}",
                    parameters.name, parameters.width, kWidestCheck));
  }
  if (bits < 1 || bits > kMostBits) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("{} bits of message and check are outside 1 to {}", bits, kMostBits));
  }
}

}  // namespace

std::uint64_t words_to_weigh(const line::FrameCheckParameters& parameters) {
  return sequences_of(walk_for(polynomial_of(parameters)).polynomial);
}

DualWeights dual_weights(const line::FrameCheckParameters& parameters, unsigned bits,
                         const DualProgress& on_progress) {
  check_limits(parameters, bits);
  const Walk plan = walk_for(polynomial_of(parameters));
  WindowWalk walk(plan.polynomial, bits, sequences_of(plan.polynomial) >= kManyWindows, on_progress);
  for (const RegisterCycle& cycle : register_cycles(plan.polynomial)) walk.walk(cycle);
  DualWeights weights{parameters.width, bits, walk.take_counts()};
  if (plan.has_complements) {
    const std::vector<std::uint64_t> alone = weights.count;
    for (std::size_t weight = 0; weight <= bits; ++weight) weights.count[weight] += alone[bits - weight];
  }
  FIELDPROOF_CHECK(std::accumulate(weights.count.begin(), weights.count.end(), std::uint64_t{0}) ==
                       std::uint64_t{1} << parameters.width,
                   "the words of a dual code were not weighed once each");
  return weights;
}

}  // namespace fieldproof::emc
