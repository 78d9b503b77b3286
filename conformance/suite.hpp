#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/sequence.hpp"
#include "conformance/suite_given.hpp"
#include "conformance/test_case.hpp"
#include "harness/fault/plan_part.hpp"
#include "harness/field/named_table.hpp"
#include "harness/judge/pics.hpp"
#include "harness/line/telegram.hpp"

// The suite of a protocol: its cases, its mutants, and who runs them. There is one class; a protocol gives
// rows, one for each role (conformance/bench_role.hpp makes them of cases on a bench).
namespace fieldproof::conformance {

class RunningCase;

// Sequences of a role, and how one is run: on a bench of its own; a run of a case may consist of many.
struct RoleSequences {
  SequenceRole role;
  std::function<judge::CaseResult(const Sequence&, RunningCase&)> run;
};

struct RoleRow {
  std::string name;
  std::vector<TestCase> cases{};
  std::vector<Mutant> mutants{};
  // Never throws for a misbehaving implementation: that is a verdict.
  std::function<Outcome(const TestCase&, RunningCase&)> run{};
  // Throws kernel::Error for a setup that the case cannot be run with. Null: any will do.
  std::function<void(const TestCase&, RunningCase&)> check{};
  // Makes the implementation of a URI once, before anything is judged.
  std::function<void(const std::string& uri, RunningCase&)> try_out{};
  // Null: the answers of the setup, with what is known of a station on a real line.
  std::function<std::optional<judge::Pics>(const TestCase&, RunningCase&)> declared_pics{};
  // What a PICS of the role may answer, and what is taken where it does not.
  std::vector<judge::PicsItem> pics_items{};
  judge::Pics usual_answers{};
  const field::AnyTable* settings = nullptr;
  std::optional<RoleSequences> sequences{};  // that `check` draws, too
  std::optional<RoleSequences> more_sequences{};
};

struct SuiteRows {
  std::string protocol;
  std::vector<RoleRow> roles;
  // The numbers of the protocol, besides the settings of the roles.
  std::vector<field::NamedTable> rules{};
  // Of the files that describe an installation of this protocol.
  std::vector<field::NamedSchema> schemas{};
  // Why no case takes a network of the setup, as a sentence; empty: some do.
  std::string_view why_no_network{};
  // How a plan writes the telegrams that it inserts, by the network of the setup; null: it inserts none.
  const line::TelegramCode* (*telegrams)(const std::string& network_file) = nullptr;
  // The farthest position of a role on a network of the suite's own.
  int last_position = 1;
};

class Suite {
 public:
  explicit Suite(SuiteRows rows, SuiteGiven given = {});
  Suite(const Suite&) = delete;
  Suite& operator=(const Suite&) = delete;
  virtual ~Suite() = default;

  std::string_view protocol() const { return rows_.protocol; }
  std::vector<std::string> roles() const;
  const std::vector<TestCase>& cases() const { return cases_; }
  const std::vector<Mutant>& mutants() const { return mutants_; }

  // Throws kernel::Error for a setup that cannot be served, naming what would be right; never for a
  // misbehaving implementation.
  Outcome run(const TestCase& test_case, const Setup& setup) const;
  // Throws the kernel::Error of `run` for files and places of this setup, without running anything.
  void check(const TestCase& test_case, const Setup& setup) const;

  // Whether the program brought an implementation of this role along, with the URI `own`.
  bool has_own(std::string_view role) const { return given_.own.has(role); }
  int last_position() const { return rows_.last_position; }
  const std::vector<RoleRow>& role_rows() const { return rows_.roles; }
  // What a PICS of this protocol may answer.
  std::vector<judge::PicsItem> pics_items() const;
  // The settings of each role, by its name, and the numbers of the protocol.
  std::vector<field::NamedTable> tables() const;
  const std::vector<field::NamedSchema>& schemas() const { return rows_.schemas; }
  // The answers of the setup, completed by what the suite takes for granted; nothing when the setup has none.
  std::optional<judge::Pics> declared_pics(const TestCase& test_case, const Setup& setup) const;
  // What a report must say about all results under this setup; sentences.
  std::vector<std::string> caveats(const Setup& setup) const;
  // The parts of the setup's plan of faults, in the order in which results count their hits.
  std::vector<fault::PlanPart> plan_parts(const Setup& setup) const;

  // What `check` draws sequences of, by role.
  std::span<const SequenceRole> sequence_roles() const { return sequence_roles_; }
  // What may be drawn under this setup: a setting that the PICS declares is as it says, and a station on a
  // real line is given none.
  SequenceVocabulary vocabulary(const SequenceRole& role, const Setup& setup) const;
  // One run of a sequence of one of these roles on a bench of its own; as for `run`, the seed of the setup is
  // that of the case.
  Outcome run_sequence(const SequenceRole& role, const Sequence& sequence, const Setup& setup) const;

 protected:
  // For suites that grow case by case.
  SuiteRows& rows() { return rows_; }
  RoleRow& role(std::string_view name);
  void add_case(TestCase test_case) { cases_.push_back(std::move(test_case)); }
  void add_mutant(Mutant mutant) { mutants_.push_back(std::move(mutant)); }
  SuiteGiven& given() { return given_; }

 private:
  const RoleRow& row_of(const TestCase& test_case) const;
  RunningCase begin(const TestCase& test_case, const Setup& setup) const;
  const line::TelegramCode* telegrams(const Setup& setup) const;
  void check_setup(const RoleRow& row, const TestCase& test_case, RunningCase& run) const;
  judge::CaseResult run_derived(const RoleRow& row, DerivedKind kind, RunningCase& run) const;

  SuiteRows rows_;
  SuiteGiven given_;
  std::vector<TestCase> cases_;
  std::vector<Mutant> mutants_;
  std::vector<SequenceRole> sequence_roles_;
};

}  // namespace fieldproof::conformance
