#include "emc/residual/block_check.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "emc/residual/residual_error.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

void require_block(const BlockCheck& check) {
  const unsigned most = check.has_parity ? kMostOctetsWithParity : kMostOctetsOfBlock;
  if (check.octets >= 1 && check.octets <= most) return;
  throw kernel::Error(
      kernel::ErrorKind::usage,
      fmt::format("a block check{} is over 1 to {} octets, its own with them, and not over {}.",
                  check.has_parity ? " of characters with parity" : "", most, check.octets));
}

// C(n, 0) to C(n, n), for n below 62.
std::vector<std::uint64_t> binomials(unsigned n) {
  std::vector<std::uint64_t> row{1};
  for (unsigned i = 1; i <= n; ++i) {
    row.push_back(1);
    for (unsigned k = i - 1; k >= 1; --k) row[k] += row[k - 1];
  }
  return row;
}

}  // namespace

DualWeights dual_weights(const BlockCheck& check) {
  require_block(check);
  const unsigned n = check.octets;
  DualWeights dual;
  dual.bits = check.bits();
  dual.count.resize(dual.bits + 1);
  if (!check.has_parity) {
    dual.width = 8;
    const std::vector<std::uint64_t> columns = binomials(8);
    for (unsigned c = 0; c <= 8; ++c) dual.count[c * n] += columns[c];
    return dual;
  }
  dual.width = 8 + n;
  const std::vector<std::uint64_t> rows = binomials(n);
  const std::vector<std::uint64_t> columns = binomials(9);
  for (unsigned r = 0; r <= n; ++r) {
    // The same word again is that of the other rows and the other columns: half of the columns are enough.
    for (unsigned c = 0; c <= 4; ++c) dual.count[r * (9 - c) + c * (n - r)] += rows[r] * columns[c];
  }
  return dual;
}

std::vector<BigCount> undetected_patterns(const BlockCheck& check, unsigned up_to) {
  return code_word_counts(dual_weights(check), up_to);
}

double undetected_error_probability(const BlockCheck& check, double ber) {
  return undetected_error_probability(dual_weights(check), ber);
}

}  // namespace fieldproof::emc
