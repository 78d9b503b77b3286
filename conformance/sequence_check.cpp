#include "conformance/sequence_check.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "conformance/runner.hpp"
#include "conformance/sequence_contrast.hpp"
#include "conformance/sequence_draw.hpp"
#include "conformance/sequence_shrink.hpp"

namespace fieldproof::conformance {
namespace {

// What is still not smallest by then comes from an implementation that does not repeat itself.
constexpr std::uint64_t kMostShrinkingRuns = 20'000;

bool has_failed(const Outcome& outcome) {
  return outcome.result.verdict >= judge::Verdict::fail;
}

}  // namespace

Outcome run_sequence(const Suite& suite, const SequenceRole& role, const Sequence& sequence, Setup setup) {
  setup.seed = case_seed(setup.seed, role.test_case.id);
  return suite.run_sequence(role, sequence, setup);
}

namespace {

// Runs candidates under one setup and says whether they fail for one reason.
class SameFailure {
 public:
  SameFailure(const Suite& suite, const SequenceRole& role, const Setup& setup, std::string reason,
              std::stop_token stop)
      : suite_(suite), role_(role), setup_(setup), reason_(std::move(reason)), stop_(std::move(stop)) {}

  bool operator()(const Sequence& candidate) {
    if (runs_ == kMostShrinkingRuns || stop_.stop_requested()) return false;
    ++runs_;
    return is_in(run_sequence(suite_, role_, candidate, setup_));
  }

  SequenceFound found(Sequence drawn, judge::CaseResult first, Sequence smallest) const {
    Setup recorded = setup_;
    recorded.record = true;
    const std::vector<std::string> decisive =
        contrasts(smallest, role_.vocabulary, [&](const Sequence& one) { return shows(one); });
    Outcome outcome = run_sequence(suite_, role_, smallest, recorded);
    for (judge::Finding& finding : outcome.result.findings) finding.decisive = decisive;
    const bool is_confirmed = is_in(outcome);
    return {std::move(drawn), std::move(smallest), std::move(outcome), std::move(first), runs_, is_confirmed};
  }

 private:
  Shown shows(const Sequence& candidate) const {
    if (stop_.stop_requested()) return Shown::not_tried;
    return shown_by(run_sequence(suite_, role_, candidate, setup_).result, reason_);
  }
  bool is_in(const Outcome& outcome) const { return has_failed(outcome) && outcome.result.reason == reason_; }

  const Suite& suite_;
  const SequenceRole& role_;
  const Setup& setup_;
  std::string reason_;
  std::stop_token stop_;
  std::uint64_t runs_ = 0;
};

}  // namespace

SequenceSearchResult search(const SequenceSearch& search) {
  const Suite& suite = *search.suite;
  const SequenceRole& role = *search.role;
  const SequenceVocabulary vocabulary = suite.vocabulary(role, search.setup);
  const SequenceSource source(vocabulary, search.setup.seed);
  SequenceSearchResult result;
  for (; result.run < search.cases && !search.stop.stop_requested(); ++result.run) {
    if (search.on_progress) search.on_progress(result.run);
    const Sequence drawn = source.draw(result.run);
    const Outcome outcome = run_sequence(suite, role, drawn, search.setup);
    if (!has_failed(outcome)) {
      const bool has_passed = outcome.result.verdict == judge::Verdict::pass;
      result.passed += has_passed ? 1 : 0;
      result.silent += has_passed && !outcome.result.has_driven ? 1 : 0;
      result.not_applicable += outcome.result.verdict == judge::Verdict::not_applicable ? 1 : 0;
      result.inconclusive += outcome.result.verdict == judge::Verdict::inconclusive ? 1 : 0;
      continue;
    }
    SameFailure same(suite, role, search.setup, outcome.result.reason, search.stop);
    const SequenceFails still_fails = std::ref(same);
    const Sequence smaller = source.smaller(result.run, still_fails);
    result.found = same.found(drawn, outcome.result, shrunk(smaller, role.vocabulary, still_fails));
    break;
  }
  return result;
}

std::optional<SequenceFound> shrink(const Suite& suite, const SequenceRole& role, const Sequence& sequence,
                                    const Setup& setup, std::stop_token stop) {
  const Outcome outcome = run_sequence(suite, role, sequence, setup);
  if (!has_failed(outcome)) return std::nullopt;
  SameFailure same(suite, role, setup, outcome.result.reason, std::move(stop));
  return same.found(sequence, outcome.result, shrunk(sequence, role.vocabulary, std::ref(same)));
}

}  // namespace fieldproof::conformance
