#include "conformance/suite.hpp"

#include <algorithm>
#include <utility>

#include "conformance/derived_cases.hpp"
#include "conformance/reference_walks.hpp"
#include "conformance/running_case.hpp"
#include "conformance/stressed_receiver.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

bool is_named_in(const std::vector<TestCase>& cases, const Mutant& mutant) {
  return std::ranges::any_of(cases, [&](const TestCase& one) {
    return one.role() == mutant.role && std::ranges::any_of(one.catches, [&](const MustCatch& caught) {
             return caught.mutant == mutant.name;
           });
  });
}

// Those of whose role this is true, of the two that a row may have.
template <typename IsOfRole>
const std::optional<RoleSequences>& sequences_of(const RoleRow& row, const IsOfRole& is_of_role) {
  return row.more_sequences && is_of_role(row.more_sequences->role) ? row.more_sequences : row.sequences;
}

}  // namespace

Suite::Suite(SuiteRows rows, SuiteGiven given) : rows_(std::move(rows)), given_(std::move(given)) {
  for (RoleRow& row : rows_.roles) {
    std::vector<TestCase> left_out;
    for (TestCase& one : row.cases) {
      const bool is_out = !given_.disturbances.have_stresses() && has_tag(one, kStressTag);
      (is_out ? left_out : cases_).push_back(std::move(one));
    }
    // Mutants that only bursts tell are no survivors of a suite that was given none.
    for (Mutant& one : row.mutants) {
      if (is_named_in(left_out, one) && !is_named_in(cases_, one)) continue;
      mutants_.push_back(std::move(one));
    }
    if (row.sequences) sequence_roles_.push_back(row.sequences->role);
    for (const auto* const sequences : {&row.sequences, &row.more_sequences}) {
      if (!*sequences) continue;
      for (TestCase& one : derived_cases((*sequences)->role)) cases_.push_back(std::move(one));
    }
    row.cases.clear();
    row.mutants.clear();
  }
}

std::vector<std::string> Suite::roles() const {
  std::vector<std::string> names;
  for (const RoleRow& row : rows_.roles) names.push_back(row.name);
  return names;
}

RoleRow& Suite::role(std::string_view name) {
  const auto found = std::ranges::find(rows_.roles, name, &RoleRow::name);
  FIELDPROOF_CHECK(found != rows_.roles.end(), "a suite has a row for the role of each case");
  return *found;
}

const RoleRow& Suite::row_of(const TestCase& test_case) const {
  return const_cast<Suite*>(this)->role(test_case.role());
}

const line::TelegramCode* Suite::telegrams(const Setup& setup) const {
  return rows_.telegrams == nullptr || setup.plan_file.empty() ? nullptr
                                                               : rows_.telegrams(setup.network_file);
}

RunningCase Suite::begin(const TestCase& test_case, const Setup& setup) const {
  return RunningCase(test_case, setup, given_, telegrams(setup));
}

void Suite::check_setup(const RoleRow& row, const TestCase& test_case, RunningCase& run) const {
  if (!run.setup().network_file.empty() && !rows_.why_no_network.empty())
    throw kernel::Error(kernel::ErrorKind::usage, std::string(rows_.why_no_network));
  if (row.check) row.check(test_case, run);
}

Outcome Suite::run(const TestCase& test_case, const Setup& setup) const {
  const RoleRow& row = row_of(test_case);
  RunningCase run = begin(test_case, setup);
  check_setup(row, test_case, run);
  Outcome outcome;
  if (const auto kind = derived_kind(test_case)) {
    outcome.result = run_derived(row, *kind, run);
    run.keep(outcome);
  } else {
    outcome = row.run(test_case, run);
    // A finding of sequences names the settings of its own.
    if (!outcome.result.findings.empty() && row.settings != nullptr)
      outcome.result.settings = run.unusual_settings(*row.settings);
  }
  outcome.happens_once = run.is_on_real_line();
  return outcome;
}

SequenceVocabulary Suite::vocabulary(const SequenceRole& role, const Setup& setup) const {
  const RunningCase run = begin(role.test_case, setup);
  SequenceVocabulary vocabulary = role.vocabulary;
  std::erase_if(vocabulary.settings, [&](const SequenceSetting& one) {
    return run.is_on_real_line() || (setup.pics && setup.pics->items().contains(one.name));
  });
  return vocabulary;
}

Outcome Suite::run_sequence(const SequenceRole& role, const Sequence& sequence, const Setup& setup) const {
  const RoleRow& row = row_of(role.test_case);
  const std::optional<RoleSequences>& sequences =
      sequences_of(row, [&](const SequenceRole& one) { return one.test_case.id == role.test_case.id; });
  FIELDPROOF_CHECK(bool(sequences),
                   "a suite runs sequences of the roles that it names: " + role.test_case.id);
  RunningCase run = begin(role.test_case, setup);
  run.use_settings(sequence.settings);
  Outcome outcome{sequences->run(sequence, run), {}};
  run.keep(outcome);
  outcome.happens_once = run.is_on_real_line();
  return outcome;
}

judge::CaseResult Suite::run_derived(const RoleRow& row, DerivedKind kind, RunningCase& run) const {
  const RoleSequences& sequences = *sequences_of(
      row, [&](const SequenceRole& one) { return derived_id(one, kind) == run.test_case().id; });
  const SequenceVocabulary vocabulary = this->vocabulary(sequences.role, run.setup());
  const std::size_t most =
      run.is_on_real_line()
          ? kDerivedOnRealLine
          : run.setup().sequences.value_or(derived_count(kind, run.setup().volume, sequences.role.cost));
  const bool has_time = run.setup().volume == Volume::full && !run.is_on_real_line();
  const kernel::Random random = kernel::Random(run.setup().seed).split("derived");
  DerivedSequences derived =
      kind == DerivedKind::walks
          ? walk_sequences(*this, sequences.role, has_time ? Volume::full : Volume::quick, most, random)
          : derived_sequences(kind, vocabulary, most, random, has_time ? kMostRepetitions : kManyRepetitions);
  const auto run_one = [&](const Sequence& sequence) {
    run.use_settings(sequence.settings);
    return sequences.run(sequence, run);
  };
  return run_derived_case({.test_case = run.test_case(),
                           .vocabulary = vocabulary,
                           .parts = {{std::move(derived), run_one}},
                           .most_shrinking_commands = run.explains() ? kShrinkingCommands : 0});
}

void Suite::check(const TestCase& test_case, const Setup& setup) const {
  RunningCase run = begin(test_case, setup);
  check_setup(row_of(test_case), test_case, run);
  if (run.is_played_back()) return;
  for (const Assignment& one : setup.implementations) {
    const std::string role = one.role.empty() ? test_case.role() : one.role;
    const bool takes_part = role == test_case.role() || std::ranges::count(test_case.parts, role) > 0;
    const auto row = std::ranges::find(rows_.roles, role, &RoleRow::name);
    if (takes_part && row != rows_.roles.end() && row->try_out) row->try_out(one.uri, run);
  }
}

std::vector<judge::PicsItem> Suite::pics_items() const {
  std::vector<judge::PicsItem> all;
  for (const RoleRow& row : rows_.roles) all.insert(all.end(), row.pics_items.begin(), row.pics_items.end());
  return all;
}

std::vector<field::NamedTable> Suite::tables() const {
  std::vector<field::NamedTable> all;
  for (const RoleRow& row : rows_.roles)
    if (row.settings != nullptr) all.push_back({row.name, row.settings});
  all.insert(all.end(), rows_.rules.begin(), rows_.rules.end());
  return all;
}

std::optional<judge::Pics> Suite::declared_pics(const TestCase& test_case, const Setup& setup) const {
  const RoleRow& row = row_of(test_case);
  RunningCase run = begin(test_case, setup);
  return row.declared_pics ? row.declared_pics(test_case, run) : run.pics();
}

std::vector<std::string> Suite::caveats(const Setup& setup) const {
  return declared_plan(setup, given_, telegrams(setup)).caveats();
}

std::vector<fault::PlanPart> Suite::plan_parts(const Setup& setup) const {
  return declared_plan(setup, given_, telegrams(setup)).parts();
}

}  // namespace fieldproof::conformance
