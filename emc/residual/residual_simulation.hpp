// Simulated undetected errors, beside the exact probability: they know the check only as the remainders of
// single flips, nothing of its dual code.
//
// Counting draws flips bit by bit at the bit-error rate and counts the telegrams that pass. It reaches what
// happens once in the samples that one can afford: about 2^-16, never 2^-32.
//
// Beyond that, sampling by importance: patterns of each weight k are drawn uniformly, apart, and weighted
// with the probability of k flips,
//   P_ue = sum_k w_k f_k,  w_k = C(n, k) p^k (1 - p)^(n - k),  f_k the share of patterns of weight k that
//   pass.
// Of each pattern only k - c positions are drawn; all ways to add the last c = 1 or 2 are looked up at once
// in a sorted list of remainders. With h of them in a draw, h / C(n - k + c, c) has the expectation f_k; its
// mean and standard error over the draws are those of the weight. The estimate is sum w_k mean_k, its
// standard error the root of sum (w_k error_k)^2. A weight without a single hit contributes nothing to
// either, so the numbers of hits stand beside; weights that are left out have the total probability
// `left_out`.
//
// Deterministic: a seed gives the same patterns everywhere. Limits: widths and lengths of dual_weights.
#pragma once

#include <cstdint>
#include <vector>

#include "harness/kernel/random.hpp"
#include "harness/line/frame_check.hpp"

namespace fieldproof::emc {

struct CountedErrors {
  std::uint64_t samples = 0;     // telegrams
  std::uint64_t corrupted = 0;   // of them
  std::uint64_t undetected = 0;  // of those
};

// Costs what is hit: a telegram without a flip takes no time.
CountedErrors count_undetected_errors(const line::FrameCheckParameters& parameters, unsigned bits, double ber,
                                      std::uint64_t samples, kernel::Random random);

struct SampledWeight {
  unsigned weight = 0;
  double probability = 0;  // w_k
  std::uint64_t hits = 0;  // patterns that pass, over all draws
  double share = 0;        // f_k as estimated
  double error = 0;        // its standard error
};

struct SampledErrors {
  std::uint64_t samples_per_weight = 0;
  unsigned looked_up = 0;              // c
  std::vector<SampledWeight> weights;  // ascending
  double probability = 0;
  double standard_error = 0;
  double left_out = 0;
};

// `samples` patterns in all, shared evenly among the weights that can be expected to matter; no weight has
// fewer than 1000.
SampledErrors sample_undetected_errors(const line::FrameCheckParameters& parameters, unsigned bits,
                                       double ber, std::uint64_t samples, const kernel::Random& random);

}  // namespace fieldproof::emc
