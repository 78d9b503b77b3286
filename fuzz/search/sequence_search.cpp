#include "fuzz/search/sequence_search.hpp"

#include <algorithm>
#include <vector>

#include "conformance/sequence_draw.hpp"
#include "conformance/sequence_octets.hpp"
#include "fuzz/search/coverage.hpp"
#include "harness/kernel/random.hpp"

namespace fieldproof::fuzz {
namespace {

using Octets = std::vector<std::uint8_t>;

constexpr std::size_t kMostOctets = 500;
constexpr std::uint64_t kMostMutations = 4;
constexpr std::uint64_t kDrawnOfTen = 3;  // what is not mutated from something that was kept

// Inputs that are worth mutating, and mutation.
class Pool {
 public:
  Pool(const conformance::SequenceVocabulary& vocabulary, std::uint64_t seed)
      : vocabulary_(vocabulary), source_(vocabulary, seed), random_(seed) {}

  std::size_t size() const { return kept_.size(); }
  void keep(Octets octets) { kept_.push_back(std::move(octets)); }

  Octets next() {
    if (kept_.empty() || random_.below(10) < kDrawnOfTen)
      return octets_of_sequence(source_.draw(drawn_++), vocabulary_);
    Octets octets = kept_[random_.below(kept_.size())];
    for (std::uint64_t left = 1 + random_.below(kMostMutations); left > 0; --left) mutate(octets);
    if (octets.size() > kMostOctets) octets.resize(kMostOctets);
    return octets;
  }

 private:
  std::ptrdiff_t place_in(const Octets& octets) {
    return static_cast<std::ptrdiff_t>(random_.below(octets.size() + 1));
  }
  std::uint8_t octet() { return static_cast<std::uint8_t>(random_.below(256)); }

  void mutate(Octets& octets) {
    const std::ptrdiff_t place = place_in(octets);
    const auto left = static_cast<std::ptrdiff_t>(octets.size()) - place;
    switch (random_.below(5)) {
      case 0:  // a bit
        if (left > 0)
          octets[static_cast<std::size_t>(place)] ^= static_cast<std::uint8_t>(1U << random_.below(8));
        return;
      case 1:
        if (left > 0) octets[static_cast<std::size_t>(place)] = octet();
        return;
      case 2:
        octets.insert(octets.begin() + place, octet());
        return;
      case 3:
        octets.erase(octets.begin() + place,
                     octets.begin() + place +
                         std::min<std::ptrdiff_t>(left, static_cast<std::ptrdiff_t>(1 + random_.below(6))));
        return;
      default: {  // a part of another
        const Octets& other = kept_[random_.below(kept_.size())];
        const std::ptrdiff_t from = place_in(other);
        const std::ptrdiff_t most = static_cast<std::ptrdiff_t>(other.size()) - from;
        const std::ptrdiff_t count =
            std::min<std::ptrdiff_t>(most, static_cast<std::ptrdiff_t>(random_.below(24)));
        const Octets part(other.begin() + from, other.begin() + from + count);
        octets.insert(octets.begin() + place, part.begin(), part.end());
      }
    }
  }

  const conformance::SequenceVocabulary& vocabulary_;
  conformance::SequenceSource source_;
  kernel::Random random_;
  std::vector<Octets> kept_;
  std::uint64_t drawn_ = 0;
};

conformance::SequenceFound made_smaller(const SequenceFuzz& fuzz, const conformance::Sequence& sequence,
                                        conformance::Outcome outcome) {
  auto found = conformance::shrink(*fuzz.suite, *fuzz.role, sequence, fuzz.setup, fuzz.stop);
  if (found) return std::move(*found);
  judge::CaseResult first = outcome.result;
  return {sequence, sequence, std::move(outcome), std::move(first), 0, false};
}

}  // namespace

SequenceFuzzResult search(const SequenceFuzz& fuzz) {
  const conformance::SequenceVocabulary vocabulary = fuzz.suite->vocabulary(*fuzz.role, fuzz.setup);
  Pool pool(vocabulary, fuzz.setup.seed);
  SequenceFuzzResult result;
  for (; result.run < fuzz.runs && !fuzz.stop.stop_requested(); ++result.run) {
    if (fuzz.on_progress) fuzz.on_progress(result.run);
    Octets octets = pool.next();
    const auto sequence = conformance::sequence_of_octets(octets, vocabulary);
    begin_coverage();
    conformance::Outcome outcome = conformance::run_sequence(*fuzz.suite, *fuzz.role, sequence, fuzz.setup);
    const std::size_t edges = take_new_coverage();
    const judge::Verdict verdict = outcome.result.verdict;
    if (verdict >= judge::Verdict::fail) {
      result.found = made_smaller(fuzz, sequence, std::move(outcome));
      break;
    }
    const bool has_passed = verdict == judge::Verdict::pass;
    result.passed += has_passed ? 1 : 0;
    result.silent += has_passed && !outcome.result.has_driven ? 1 : 0;
    result.inconclusive += verdict == judge::Verdict::inconclusive ? 1 : 0;
    result.edges += edges;
    if (edges > 0 && !octets.empty()) pool.keep(std::move(octets));
  }
  result.kept = pool.size();
  result.has_coverage = has_coverage();
  return result;
}

}  // namespace fieldproof::fuzz
