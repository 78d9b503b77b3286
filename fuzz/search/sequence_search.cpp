#include "fuzz/search/sequence_search.hpp"

#include <algorithm>
#include <vector>

#include "conformance/sequence_draw.hpp"
#include "conformance/sequence_octets.hpp"
#include "fuzz/search/corpus_cover.hpp"
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

  const std::vector<CoveringInput>& kept() const { return kept_; }
  void keep(Octets octets, std::vector<std::uint64_t> features) {
    kept_.push_back({std::move(octets), std::move(features)});
  }

  Octets next() {
    if (kept_.empty() || random_.below(10) < kDrawnOfTen)
      return octets_of_sequence(source_.draw(drawn_++), vocabulary_);
    Octets octets = kept_[random_.below(kept_.size())].octets;
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
        const Octets& other = kept_[random_.below(kept_.size())].octets;
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
  std::vector<CoveringInput> kept_;
  std::uint64_t drawn_ = 0;
};

conformance::SequenceFound made_smaller(const SequenceFuzz& fuzz, const conformance::Sequence& sequence,
                                        conformance::Outcome outcome) {
  auto found = conformance::shrink(*fuzz.suite, *fuzz.role, sequence, fuzz.setup, fuzz.stop);
  if (found) return std::move(*found);
  judge::CaseResult first = outcome.result;
  return {sequence, sequence, std::move(outcome), std::move(first), 0, false};
}

// After other seeds other sequences are drawn: a search that goes on does not begin with the same ones again.
std::uint64_t seed_after(std::uint64_t seed, const std::vector<Octets>& seeds) {
  constexpr std::uint64_t kPrime = 0x100000001B3;  // FNV-1a
  for (const Octets& octets : seeds) {
    for (const std::uint8_t octet : octets) seed = (seed ^ octet) * kPrime;
    seed = (seed ^ octets.size()) * kPrime;
  }
  return seed;
}

bool is_shown(std::uint64_t run) {
  while (run >= 10 && run % 10 == 0) run /= 10;
  return run == 1 || run == 2 || run == 5;
}

class SearchRun {
 public:
  explicit SearchRun(const SequenceFuzz& fuzz)
      : fuzz_(fuzz),
        vocabulary_(fuzz.suite->vocabulary(*fuzz.role, fuzz.setup)),
        seeds_(octets_of_seeds()),
        pool_(vocabulary_, seed_after(fuzz.setup.seed, seeds_)) {}

  SequenceFuzzResult run() {
    run_seeds();
    while (!result_.found && result_.run < fuzz_.runs && !fuzz_.stop.stop_requested()) {
      run_one(pool_.next());
      if (!result_.found) ++result_.run;
    }
    note_growth();
    result_.kept = pool_.kept().size();
    result_.has_coverage = has_coverage();
    result_.corpus = corpus();
    return std::move(result_);
  }

 private:
  std::vector<Octets> octets_of_seeds() const {
    std::vector<Octets> all;
    for (const conformance::Sequence& seed : fuzz_.seeds)
      all.push_back(octets_of_sequence(seed, vocabulary_));
    return all;
  }

  void run_seeds() {
    for (const Octets& octets : seeds_) {
      if (fuzz_.stop.stop_requested()) return;
      run_one(octets);
      result_.is_found_in_seed = result_.found.has_value();
      if (result_.found) return;
      ++result_.seeds_run;
    }
    if (!seeds_.empty()) note_growth();
  }

  void run_one(Octets octets) {
    const auto sequence = conformance::sequence_of_octets(octets, vocabulary_);
    if (fuzz_.on_begin) fuzz_.on_begin(result_, octets);
    begin_coverage();
    conformance::Outcome outcome =
        conformance::run_sequence(*fuzz_.suite, *fuzz_.role, sequence, fuzz_.setup);
    RunCoverage coverage = take_coverage();
    const judge::Verdict verdict = outcome.result.verdict;
    if (verdict >= judge::Verdict::fail) {
      if (fuzz_.on_found) fuzz_.on_found();
      result_.found = made_smaller(fuzz_, sequence, std::move(outcome));
      return;
    }
    const bool has_passed = verdict == judge::Verdict::pass;
    result_.passed += has_passed ? 1 : 0;
    result_.silent += has_passed && !outcome.result.has_driven ? 1 : 0;
    result_.inconclusive += verdict == judge::Verdict::inconclusive ? 1 : 0;
    result_.edges += coverage.new_edges;
    if (coverage.new_features > 0 && !octets.empty()) {
      if (fuzz_.on_kept) fuzz_.on_kept(octets);
      pool_.keep(std::move(octets), std::move(coverage.features));
    }
    if (is_shown(++run_)) note_growth();
  }

  void note_growth() {
    const GrowthPoint point{run_, result_.edges, pool_.kept().size()};
    if (run_ > 0 && (result_.growth.empty() || result_.growth.back().run != run_))
      result_.growth.push_back(point);
  }

  std::vector<conformance::Sequence> corpus() const {
    if (!has_coverage()) return fuzz_.seeds;
    std::vector<conformance::Sequence> all;
    for (const std::size_t place : smallest_cover(pool_.kept()))
      all.push_back(conformance::sequence_of_octets(pool_.kept()[place].octets, vocabulary_));
    const auto not_run = fuzz_.seeds.begin() + static_cast<std::ptrdiff_t>(result_.seeds_run);
    all.insert(all.end(), not_run, fuzz_.seeds.end());
    return all;
  }

  const SequenceFuzz& fuzz_;
  conformance::SequenceVocabulary vocabulary_;
  std::vector<Octets> seeds_;
  Pool pool_;
  SequenceFuzzResult result_;
  std::uint64_t run_ = 0;
};

}  // namespace

SequenceFuzzResult search(const SequenceFuzz& fuzz) {
  return SearchRun(fuzz).run();
}

}  // namespace fieldproof::fuzz
