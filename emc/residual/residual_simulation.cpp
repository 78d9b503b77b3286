#include "emc/residual/residual_simulation.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>

#include "emc/residual/dual_weights.hpp"
#include "harness/kernel/check.hpp"

namespace fieldproof::emc {
namespace {

// The list of pairs grows with the square of the length: 8 million pairs at this one.
constexpr unsigned kLongestForPairs = 4096;
// Weights whose contribution cannot exceed this part of the estimate are left out.
constexpr double kNegligible = 1e-4;
constexpr std::uint64_t kFewestPatterns = 1000;

std::vector<std::uint32_t> remainders_of(const line::FrameCheckParameters& p, unsigned bits) {
  FIELDPROOF_CHECK(p.width <= kWidestCheck && bits >= 1 && bits <= kMostBits,
                   "errors are simulated only within the limits of the exact computation");
  std::vector<std::uint32_t> remainders(bits);
  std::uint64_t power = 1;
  for (std::uint32_t& remainder : remainders) {
    remainder = static_cast<std::uint32_t>(power);
    power <<= 1;
    if ((power >> p.width) != 0) power ^= (std::uint64_t{1} << p.width) ^ static_cast<std::uint64_t>(p.poly);
  }
  return remainders;
}

// What one or two flips add to the remainder; `second` is `first` for one.
struct Completion {
  std::uint32_t remainder;
  std::uint32_t first;
  std::uint32_t second;
};

std::vector<Completion> completions_of(const std::vector<std::uint32_t>& remainders, unsigned looked_up) {
  const auto bits = static_cast<std::uint32_t>(remainders.size());
  std::vector<Completion> all;
  for (std::uint32_t i = 0; i < bits; ++i) {
    if (looked_up == 1) all.push_back({remainders[i], i, i});
    for (std::uint32_t j = i + 1; looked_up == 2 && j < bits; ++j) {
      all.push_back({remainders[i] ^ remainders[j], i, j});
    }
  }
  std::sort(all.begin(), all.end(),
            [](const Completion& a, const Completion& b) { return a.remainder < b.remainder; });
  return all;
}

class WeightSampler {
 public:
  WeightSampler(std::vector<std::uint32_t> remainders, unsigned looked_up)
      : remainders_(std::move(remainders)),
        looked_up_(looked_up),
        completions_(completions_of(remainders_, looked_up)),
        is_flipped_(remainders_.size()) {}

  // Fills in all but the probability of the weight.
  SampledWeight sample(unsigned weight, std::uint64_t samples, kernel::Random random) {
    const unsigned drawn = weight - looked_up_;
    double squares = 0;
    SampledWeight result{weight, 0, 0, 0, 0};
    for (std::uint64_t i = 0; i < samples; ++i) {
      const auto hits = static_cast<double>(hits_of_one_draw(drawn, random));
      result.hits += static_cast<std::uint64_t>(hits);
      squares += hits * hits;
    }
    const auto count = static_cast<double>(samples);
    const double mean = static_cast<double>(result.hits) / count;
    const double variance = std::max(0.0, squares / count - mean * mean);
    const double ways = ways_to_complete(drawn);
    result.share = mean / ways;
    result.error = std::sqrt(variance / count) / ways;
    return result;
  }

 private:
  double ways_to_complete(unsigned drawn) const {
    const auto free = static_cast<double>(remainders_.size() - drawn);
    return looked_up_ == 1 ? free : free * (free - 1) / 2;
  }

  std::uint64_t hits_of_one_draw(unsigned drawn, kernel::Random& random) {
    std::uint32_t remainder = 0;
    positions_.clear();
    while (positions_.size() < drawn) {
      const std::uint64_t position = random.below(remainders_.size());
      if (is_flipped_[position]) continue;
      is_flipped_[position] = true;
      positions_.push_back(position);
      remainder ^= remainders_[position];
    }
    std::uint64_t hits = 0;
    for (auto at = std::lower_bound(
             completions_.begin(), completions_.end(), remainder,
             [](const Completion& completion, std::uint32_t value) { return completion.remainder < value; });
         at != completions_.end() && at->remainder == remainder; ++at) {
      if (!is_flipped_[at->first] && !is_flipped_[at->second]) ++hits;
    }
    for (const std::uint64_t position : positions_) is_flipped_[position] = false;
    return hits;
  }

  std::vector<std::uint32_t> remainders_;
  unsigned looked_up_;
  std::vector<Completion> completions_;
  std::vector<bool> is_flipped_;
  std::vector<std::uint64_t> positions_;
};

// Even shares of the weights within six standard deviations, and of the few that matter where flips are rare.
std::uint64_t patterns_per_weight(std::uint64_t samples, unsigned bits, double ber) {
  const double weights = 8 + 12 * std::sqrt(bits * ber * (1 - ber));
  return std::max(kFewestPatterns, static_cast<std::uint64_t>(static_cast<double>(samples) / weights));
}

}  // namespace

CountedErrors count_undetected_errors(const line::FrameCheckParameters& parameters, unsigned bits, double ber,
                                      std::uint64_t samples, kernel::Random random) {
  const std::vector<std::uint32_t> remainders = remainders_of(parameters, bits);
  FIELDPROOF_CHECK(samples <= std::numeric_limits<std::uint64_t>::max() / (2 * std::uint64_t{bits}),
                   "more bits are simulated than can be counted");
  const kernel::GeometricSkip skip(ber);
  const std::uint64_t end = samples * bits;
  CountedErrors counted{samples, 0, 0};
  // All telegrams are one row of bits; `at` is the next flip in it.
  std::uint64_t at = skip(random);
  while (at < end) {
    const std::uint64_t first = at - at % bits;
    std::uint32_t remainder = 0;
    while (at < first + bits) {
      remainder ^= remainders[at - first];
      const std::uint64_t untouched = skip(random);
      at = untouched < end ? at + 1 + untouched : end;
    }
    ++counted.corrupted;
    if (remainder == 0) ++counted.undetected;
  }
  return counted;
}

SampledErrors sample_undetected_errors(const line::FrameCheckParameters& parameters, unsigned bits,
                                       double ber, std::uint64_t samples, const kernel::Random& random) {
  SampledErrors sampled;
  sampled.samples_per_weight = patterns_per_weight(samples, bits, ber);
  sampled.looked_up = bits <= kLongestForPairs ? 2 : 1;
  WeightSampler sampler(remainders_of(parameters, bits), sampled.looked_up);
  const boost::math::binomial flips(bits, ber);
  const double least_cumulated = std::ldexp(kNegligible, -static_cast<int>(parameters.width));
  double variance = 0;
  double largest_share = 0;
  // One flip is always seen.
  for (unsigned weight = 2; weight <= bits; ++weight) {
    if (boost::math::cdf(flips, weight) < least_cumulated) {
      sampled.left_out =
          boost::math::cdf(flips, weight) - boost::math::pdf(flips, 0) - boost::math::pdf(flips, 1);
      continue;
    }
    SampledWeight one = sampler.sample(weight, sampled.samples_per_weight, random.split(weight));
    one.probability = boost::math::pdf(flips, weight);
    sampled.weights.push_back(one);
    sampled.probability += one.probability * one.share;
    variance += one.probability * one.error * one.probability * one.error;
    largest_share = std::max(largest_share, one.share);
    const double beyond = boost::math::cdf(complement(flips, weight));
    if (sampled.probability > 0 && beyond * largest_share < kNegligible * sampled.probability) {
      sampled.left_out += beyond;
      break;
    }
  }
  sampled.standard_error = std::sqrt(variance);
  return sampled;
}

}  // namespace fieldproof::emc
