// How many code words of each weight a frame check has: which patterns of k flips it cannot see, counted.
//
// By the identity of MacWilliams from the weights of the dual code (dual_weights): A_k is the sum of B_j
// K_k(j) over 2^width, K_k the Krawtchouk polynomial. All of it in whole numbers without limit of size, so
// every A_k is exact. The first few weights take microseconds; a whole distribution takes bits^2 steps on
// numbers of as many bits: about a second at 4000.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <optional>
#include <vector>

#include "emc/residual/dual_weights.hpp"

namespace fieldproof::emc {

using BigCount = boost::multiprecision::cpp_int;

// A_0, A_1, ... one after the other. A_0 is 1: no flip is not seen either.
class WeightSeries {
 public:
  explicit WeightSeries(const DualWeights& dual);

  // The next A_k; `bits` + 1 of them.
  BigCount next();

 private:
  // Weights j and bits - j together: K_k(bits - j) = (-1)^k K_k(j).
  struct Term {
    std::int64_t slope;  // bits - 2 j
    BigCount even;       // B_j + B_(bits - j)
    BigCount odd;        // B_j - B_(bits - j)
    BigCount before;     // K_(k-1)(j)
    BigCount now;        // K_k(j)
  };

  unsigned width_;
  std::int64_t bits_;
  std::int64_t k_ = 0;
  std::vector<Term> terms_;
};

// A_0 to A_up_to; `up_to` is at most the number of bits.
std::vector<BigCount> code_word_counts(const DualWeights& dual, unsigned up_to);

// The least number of flips that some pattern hides; nothing where no code word but zero exists.
std::optional<unsigned> hamming_distance(const DualWeights& dual);

}  // namespace fieldproof::emc
