#include "emc/residual/weight_distribution.hpp"

#include "harness/kernel/check.hpp"

namespace fieldproof::emc {

WeightSeries::WeightSeries(const DualWeights& dual) : width_(dual.width), bits_(dual.bits) {
  for (unsigned j = 0; 2 * j <= dual.bits; ++j) {
    const BigCount count = dual.count[j];
    const BigCount mirrored = 2 * j == dual.bits ? 0 : dual.count[dual.bits - j];
    if (count == 0 && mirrored == 0) continue;
    terms_.push_back({bits_ - 2 * std::int64_t{j}, count + mirrored, count - mirrored, 0, 1});
  }
}

BigCount WeightSeries::next() {
  FIELDPROOF_CHECK(k_ <= bits_, "a weight is asked for that is larger than the code word");
  BigCount sum = 0;
  for (Term& term : terms_) {
    sum += (k_ % 2 == 0 ? term.even : term.odd) * term.now;
    // (k + 1) K_(k+1)(j) = (n - 2 j) K_k(j) - (n - k + 1) K_(k-1)(j)
    term.before *= k_ - bits_ - 1;
    term.before += term.slope * term.now;
    term.before /= k_ + 1;
    std::swap(term.before, term.now);
  }
  ++k_;
  BigCount words = sum >> width_;
  FIELDPROOF_CHECK(sum >= 0 && (words << width_) == sum, "a number of code words is no whole number");
  return words;
}

std::vector<BigCount> code_word_counts(const DualWeights& dual, unsigned up_to) {
  FIELDPROOF_CHECK(up_to <= dual.bits, "weights are asked for that are larger than the code word");
  WeightSeries series(dual);
  std::vector<BigCount> words;
  for (unsigned k = 0; k <= up_to; ++k) words.push_back(series.next());
  return words;
}

std::optional<unsigned> hamming_distance(const DualWeights& dual) {
  if (dual.bits <= dual.width) return std::nullopt;
  WeightSeries series(dual);
  series.next();
  unsigned weight = 1;
  // The generator itself is a code word, so this ends.
  while (series.next() == 0) ++weight;
  return weight;
}

}  // namespace fieldproof::emc
