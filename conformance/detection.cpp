#include "conformance/detection.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "conformance/ordered_work.hpp"
#include "conformance/sequence_check.hpp"
#include "conformance/sequence_draw.hpp"

namespace fieldproof::conformance {
namespace {

struct SeedDetections {
  std::vector<Detection> of_mutants;
  std::vector<std::string> false_alarms;
  bool is_complete = true;
};

// All mutants under one seed: they share the sequences and what the reference did.
class SeedDetection {
 public:
  SeedDetection(const DetectionPlan& plan, const std::vector<MutantDetections>& mutants, std::uint64_t seed)
      : plan_(plan), mutants_(mutants) {
    setup_ = plan.setup;
    setup_.seed = seed;
    made_.of_mutants.resize(mutants.size());
  }

  SeedDetections run() {
    const SequenceVocabulary vocabulary = plan_.suite->vocabulary(*plan_.role, setup_);
    const SequenceSource source(vocabulary, setup_.seed);
    std::size_t left = mutants_.size();
    std::uint64_t commands = 0;
    for (std::uint64_t n = 0; left > 0 && commands < plan_.most_commands; ++n) {
      if (plan_.stop.stop_requested()) {
        made_.is_complete = false;
        break;
      }
      const Sequence sequence = source.draw(n);
      commands += std::max<std::size_t>(1, sequence.commands.size());
      left -= detect(sequence, commands);
    }
    return std::move(made_);
  }

 private:
  // The number of mutants that are found with this one.
  std::size_t detect(const Sequence& sequence, std::uint64_t commands) {
    const judge::CaseResult reference = result_of("ref", sequence);
    if (reference.verdict >= judge::Verdict::fail)
      made_.false_alarms.push_back(fmt::format("seed {}: {}", setup_.seed, reference.reason));
    std::size_t found = 0;
    for (std::size_t m = 0; m < mutants_.size(); ++m) {
      Detection& one = made_.of_mutants[m];
      if (one.found) continue;
      const judge::CaseResult result = result_of("mutant:" + mutants_[m].mutant->name, sequence);
      one.commands = commands;
      if (!one.triggered && result.fingerprint != reference.fingerprint) one.triggered = commands;
      if (result.verdict < judge::Verdict::fail) continue;
      one.found = commands;
      one.reason = result.reason;
      ++found;
    }
    return found;
  }

  judge::CaseResult result_of(const std::string& uri, const Sequence& sequence) {
    setup_.implementations = {{.role = plan_.role->test_case.role(), .position = 0, .uri = uri}};
    return run_sequence(*plan_.suite, *plan_.role, sequence, setup_).result;
  }

  const DetectionPlan& plan_;
  const std::vector<MutantDetections>& mutants_;
  Setup setup_;
  SeedDetections made_;
};

std::string suite_catch(const Suite& suite, const Mutant& mutant) {
  for (const TestCase& one : suite.cases()) {
    if (one.role() != mutant.role) continue;
    for (const MustCatch& caught : one.catches)
      if (caught.mutant == mutant.name) return fmt::format("{} ({})", one.id, caught.reason);
  }
  return {};
}

}  // namespace

std::uint64_t DetectionTable::found() const {
  std::uint64_t count = 0;
  for (const MutantDetections& one : mutants) {
    count += static_cast<std::uint64_t>(
        std::ranges::count_if(one.by_seed, [](const Detection& seed) { return seed.found.has_value(); }));
  }
  return count;
}

DetectionTable detect_mutants(const DetectionPlan& plan) {
  const TestCase& test_case = plan.role->test_case;
  DetectionTable table{.role = fmt::format("{}/{}", plan.suite->protocol(), test_case.role()),
                       .first_seed = plan.setup.seed,
                       .seeds = plan.seeds,
                       .most_commands = plan.most_commands};
  for (const Mutant& mutant : plan.suite->mutants())
    if (mutant.role == test_case.role())
      table.mutants.push_back({&mutant, {}, suite_catch(*plan.suite, mutant)});
  OrderedWork<SeedDetections> work;
  work.count = plan.seeds;
  work.threads = plan.jobs;
  work.work = [&](std::size_t n) { return SeedDetection(plan, table.mutants, plan.setup.seed + n).run(); };
  work.deliver = [&](std::size_t, SeedDetections&& one) {
    for (std::size_t m = 0; m < table.mutants.size(); ++m)
      table.mutants[m].by_seed.push_back(std::move(one.of_mutants[m]));
    table.false_alarms.insert(table.false_alarms.end(), one.false_alarms.begin(), one.false_alarms.end());
    table.is_complete = table.is_complete && one.is_complete;
    return true;
  };
  work.run();
  return table;
}

}  // namespace fieldproof::conformance
