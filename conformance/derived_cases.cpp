#include "conformance/derived_cases.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "conformance/commands_text.hpp"
#include "conformance/judging.hpp"
#include "conformance/sequence_contrast.hpp"
#include "conformance/sequence_shrink.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

using judge::Verdict;

constexpr std::string_view kFolder = "/derived/";
constexpr std::string_view kFolderOfCheck = "/check/";
constexpr std::string_view kOfImplementation = "implementation_";  // reasons begin so: it crashed, it hangs
constexpr std::size_t kFewerIfSanitized = 16;
constexpr std::size_t kFewestSequences = 3;
constexpr std::size_t kLeastShrinkingRuns = 20;  // of a sequence so long that its commands allow few
constexpr std::uint64_t kFingerprintFactor = 0x100'0000'01B3;  // of FNV-1a

const DerivedRow& row_of(DerivedKind kind) {
  return *std::ranges::find(kDerivedRows, kind, &DerivedRow::kind);
}

TestCase derived_case(const SequenceRole& role, const DerivedRow& row) {
  TestCase one = role.test_case;
  one.id = derived_id(role, row.kind);
  one.purpose = "derived";
  one.stimulus = row.stimulus;
  one.tags = {"derived"};
  one.catches.clear();
  for (const DerivedCatch& derived : role.derived_catches)
    if (derived.kind == row.kind) one.catches.push_back(derived.caught);
  return one;
}

std::string commands_text(const Sequence& sequence, const SequenceVocabulary& vocabulary) {
  CommandsText said;
  for (std::string& line : sequence_lines(sequence, vocabulary)) said.add(std::move(line));
  return said.text();
}

// What comes of the sequences of one case.
class DerivedResult {
 public:
  explicit DerivedResult(const DerivedRun& given) : given_(given), part_(given.parts.data()) {
    worst_ = CaseJudge(given.test_case).run_procedure([](CaseJudge&) {});
    worst_.has_driven = false;
  }

  // False: one fails, and nothing needs to be run any more.
  bool add(const DerivedPart& part) {
    part_ = &part;
    return std::ranges::all_of(part.derived.sequences,
                               [this](const Sequence& sequence) { return add(sequence); });
  }

  bool add(const Sequence& sequence) {
    ++run_;
    judge::CaseResult one = run(sequence);
    worst_.fingerprint = (worst_.fingerprint ^ one.fingerprint) * kFingerprintFactor;
    if (one.verdict == Verdict::not_applicable) {
      if (++not_applicable_ == 1) why_not_ = std::move(one.reason);
      return true;
    }
    if (one.verdict > worst_.verdict) report(sequence, std::move(one));
    if (worst_.verdict < Verdict::fail) return true;
    make_smaller(sequence);
    return false;
  }

  judge::CaseResult take() {
    if (worst_.verdict == Verdict::pass && not_applicable_ == run_) {
      worst_.verdict = Verdict::not_applicable;
      worst_.reason = std::move(why_not_);
      return std::move(worst_);
    }
    // A few sequences need not ask for anything: whoever is silent in them is asked before it is doubted.
    if (worst_.verdict == Verdict::pass && !worst_.has_driven) add(one_of_each(given_.vocabulary));
    if (worst_.verdict == Verdict::pass && !worst_.has_driven) doubt_silence();
    measure("sequences", run_);
    const std::size_t singles = sum_of([](const DerivedSequences& one) { return one.singles; });
    if (singles > 0) {
      measure("about one thing", sum_of([](const DerivedSequences& one) { return one.taken; }));
      measure("about one thing there are", singles);
    }
    for (const DerivedPart& part : given_.parts)
      for (const auto& [name, count] : part.derived.counts) measure(name, count);
    return std::move(worst_);
  }

 private:
  // Every run counts, whatever for; but the fingerprint is that of what was judged: explaining it adds
  // nothing.
  judge::CaseResult run(const Sequence& sequence) {
    judge::CaseResult one = part_->run(sequence);
    worst_.virtual_time += one.virtual_time;
    worst_.has_driven = worst_.has_driven || one.has_driven;
    worst_.planned_hits.resize(std::max(worst_.planned_hits.size(), one.planned_hits.size()));
    for (std::size_t n = 0; n < one.planned_hits.size(); ++n) worst_.planned_hits[n] += one.planned_hits[n];
    worst_.seed = one.seed;
    return one;
  }

  void report(const Sequence& sequence, judge::CaseResult one) {
    for (judge::Finding& finding : one.findings) {
      finding.step = fmt::format("sequence {} of {}: {}", run_,
                                 sum_of([](const DerivedSequences& all) { return all.sequences.size(); }),
                                 commands_text(sequence, given_.vocabulary));
    }
    worst_.verdict = one.verdict;
    worst_.reason = std::move(one.reason);
    worst_.reference = std::move(one.reference);
    worst_.findings = std::move(one.findings);
  }

  // One that crashes or hangs is not made to do it again and again.
  void make_smaller(const Sequence& sequence) {
    if (given_.most_shrinking_commands == 0 || worst_.verdict != Verdict::fail ||
        worst_.reason.starts_with(kOfImplementation))
      return;
    const std::string reason = worst_.reason;
    const std::size_t most =
        std::max(given_.most_shrinking_commands, kLeastShrinkingRuns * (sequence.commands.size() + 1));
    std::size_t left = most;
    const SequenceShows shows = [&](const Sequence& candidate) {
      const std::size_t cost = candidate.commands.size() + 1;
      if (cost > left) return Shown::not_tried;
      left -= cost;
      return shown_by(run(candidate), reason);
    };
    const Sequence smallest = shrunk(sequence, given_.vocabulary, [&](const Sequence& candidate) {
      return shows(candidate) == Shown::alike;
    });
    left = most;
    const std::vector<std::string> decisive = contrasts(smallest, given_.vocabulary, shows);
    judge::CaseResult last = run(smallest);
    // What does not repeat itself is reported as it came first.
    if (last.verdict != Verdict::fail || last.reason != reason) return;
    report(smallest, std::move(last));
    for (judge::Finding& finding : worst_.findings) finding.decisive = decisive;
  }

  void doubt_silence() {
    judge::CaseResult silent = CaseJudge(given_.test_case).run_procedure([](CaseJudge& judge) {
      judge.inconclusive("precondition_not_met", {{"an implementation that drives its line"},
                                                  "it has driven nothing in any of the sequences"});
    });
    worst_.verdict = silent.verdict;
    worst_.reason = std::move(silent.reason);
    worst_.findings = std::move(silent.findings);
  }

  template <typename Count>
  std::size_t sum_of(Count count) const {
    std::size_t sum = 0;
    for (const DerivedPart& part : given_.parts) sum += count(part.derived);
    return sum;
  }

  void measure(std::string name, std::size_t count) {
    const auto value = static_cast<double>(count);
    worst_.measurements.push_back({std::move(name), "", value, value, value});
  }

  const DerivedRun& given_;
  const DerivedPart* part_;  // that is run
  judge::CaseResult worst_;
  std::size_t run_ = 0;
  std::size_t not_applicable_ = 0;
  std::string why_not_;  // the first of them
};

}  // namespace

std::size_t derived_count(DerivedKind kind, Volume volume, std::size_t cost) {
  const DerivedRow& row = row_of(kind);
  const std::size_t count = volume == Volume::quick ? std::max(row.quick / cost, kFewestSequences) : row.full;
  // A sanitizer looks at what the code does, not at how often it holds.
  return kernel::kIsSanitized ? std::max(count / kFewerIfSanitized, kFewestSequences) : count;
}

std::string derived_id(const SequenceRole& role, DerivedKind kind) {
  const std::string& id = role.test_case.id;
  return fmt::format("{}{}{}", id.substr(0, id.find(kFolderOfCheck)), kFolder, row_of(kind).name);
}

std::vector<TestCase> derived_cases(const SequenceRole& role) {
  std::vector<TestCase> all;
  for (const DerivedRow& row : kDerivedRows)
    if (has_derived(row.kind, role.vocabulary)) all.push_back(derived_case(role, row));
  // What catches nothing that it declares proves nothing.
  std::erase_if(all, [](const TestCase& one) { return one.catches.empty(); });
  return all;
}

std::vector<DerivedExtent> derived_extents(const SequenceRole& role) {
  std::vector<DerivedExtent> all;
  for (const TestCase& one : derived_cases(role)) {
    const DerivedKind kind = *derived_kind(one);
    if (kind == DerivedKind::walks || kind == DerivedKind::drawn) continue;
    const std::size_t there_are =
        derived_sequences(kind, role.vocabulary, 1, kernel::Random(1), kMostRepetitions).singles;
    const auto taken = [&](Volume volume) {
      return std::min(derived_count(kind, volume, role.cost), there_are);
    };
    all.push_back({kind, one.id, there_are, taken(Volume::quick), taken(Volume::full)});
  }
  return all;
}

std::optional<DerivedKind> derived_kind(const TestCase& test_case) {
  if (!has_tag(test_case, "derived")) return std::nullopt;
  const auto row = std::ranges::find_if(kDerivedRows, [&](const DerivedRow& one) {
    return test_case.id.ends_with(fmt::format("{}{}", kFolder, one.name));
  });
  if (row == kDerivedRows.end()) return std::nullopt;
  return row->kind;
}

judge::CaseResult run_derived_case(const DerivedRun& given) {
  DerivedResult all(given);
  for (const DerivedPart& part : given.parts)
    if (!all.add(part)) break;
  return all.take();
}

}  // namespace fieldproof::conformance
