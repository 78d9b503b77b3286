#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "harness/kernel/random.hpp"

// Rows of values in which each two values of two factors stand together at least once (a covering array of
// strength two, found greedily): few rows show what any two answers or settings do to each other.
namespace fieldproof::conformance {

// The value of each factor, by its number.
using ValueRow = std::vector<std::size_t>;

struct CoveringArray {
  std::vector<ValueRow> rows{};
  std::size_t pairs = 0;     // of values of two factors
  std::size_t left_out = 0;  // of these, for which no row was found that may be
};

// `values`: how many each factor has, at least one. A row for which `may_be` is false is never taken; a pair
// is left out after `kTriesOfPair` rows with it that may not be. The same stream gives the same rows.
inline constexpr unsigned kTriesOfPair = 50;
CoveringArray covering_array(const std::vector<std::size_t>& values,
                             const std::function<bool(const ValueRow&)>& may_be, kernel::Random random);

}  // namespace fieldproof::conformance
