#include "conformance/matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "conformance/derived_cases.hpp"
#include "conformance/ordered_work.hpp"
#include "conformance/runner.hpp"

namespace fieldproof::conformance {
namespace {

using judge::Verdict;

// One run: a case on the reference (no mutant) or on a mutant.
struct PlannedRun {
  std::size_t role = 0;
  std::size_t row = 0;
  const Mutant* mutant = nullptr;
  Cell* cell = nullptr;
};

RoleMatrix blank_role(const Suite& suite, const std::string& role) {
  RoleMatrix matrix;
  matrix.role = role;
  for (const TestCase& test_case : suite.cases()) {
    if (test_case.role() == role && !is_canary(test_case)) matrix.cases.push_back(&test_case);
  }
  for (const Mutant& mutant : suite.mutants()) {
    if (mutant.role == role && !mutant.is_for_check) matrix.mutants.push_back(&mutant);
  }
  matrix.reference.resize(matrix.cases.size());
  matrix.cells.assign(matrix.cases.size(), std::vector<Cell>(matrix.mutants.size()));
  return matrix;
}

std::string declared_reason(const TestCase& test_case, const Mutant* mutant) {
  if (mutant == nullptr) return {};
  const auto found = std::find_if(test_case.catches.begin(), test_case.catches.end(),
                                  [&](const MustCatch& caught) { return caught.mutant == mutant->name; });
  return found == test_case.catches.end() ? std::string{} : found->reason;
}

std::vector<PlannedRun> planned_runs(Matrix& matrix, bool declared_only) {
  std::vector<PlannedRun> runs;
  for (std::size_t role = 0; role < matrix.roles.size(); ++role) {
    RoleMatrix& block = matrix.roles[role];
    for (std::size_t row = 0; row < block.cases.size(); ++row) {
      runs.push_back({role, row, nullptr, &block.reference[row]});
      const bool is_declared_only = declared_only || derived_kind(*block.cases[row]).has_value();
      for (std::size_t column = 0; column < block.mutants.size(); ++column) {
        if (is_declared_only && declared_reason(*block.cases[row], block.mutants[column]).empty()) continue;
        runs.push_back({role, row, block.mutants[column], &block.cells[row][column]});
      }
    }
  }
  return runs;
}

bool has_failing_finding(const judge::CaseResult& result, const std::string& reason) {
  return result.reason == reason ||
         std::any_of(result.findings.begin(), result.findings.end(), [&](const judge::Finding& finding) {
           return finding.verdict == Verdict::fail && finding.reason == reason;
         });
}

CellKind kind_of(const judge::CaseResult& result, const std::string& declared) {
  const bool is_declared = !declared.empty();
  switch (result.verdict) {
    case Verdict::error:
      return CellKind::wrong_cause;
    case Verdict::fail:
      if (!is_declared) return CellKind::caught_undeclared;
      return has_failing_finding(result, declared) ? CellKind::caught : CellKind::wrong_cause;
    case Verdict::not_applicable:
      return is_declared ? CellKind::missed : CellKind::not_applicable;
    default:
      return is_declared ? CellKind::missed : CellKind::passed;
  }
}

Cell run_cell(const Suite& suite, const TestCase& test_case, const Mutant* mutant, std::uint64_t seed) {
  Setup setup;
  setup.seed = seed;
  setup.volume = Volume::quick;
  setup.explains = false;
  const std::string uri = mutant == nullptr ? "ref" : "mutant:" + mutant->name;
  setup.implementations.push_back({.role = test_case.role(), .position = 0, .uri = uri});
  const CaseRun done = run_case({&suite, &test_case}, setup);
  const judge::CaseResult& result = done.outcome.result;
  Cell cell;
  cell.declared = declared_reason(test_case, mutant);
  cell.verdict = result.verdict;
  cell.reason = result.reason;
  cell.kind = kind_of(result, cell.declared);
  return cell;
}

// "fails with 'x'" or "is inconclusive (y)".
std::string told(const Cell& cell) {
  const std::string reason = cell.reason.empty() ? "" : fmt::format(" ('{}')", cell.reason);
  return fmt::format("ends with {}{}", judge::name(cell.verdict), reason);
}

void find_cell_holes(const TestCase& test_case, const Mutant& mutant, const Cell& cell,
                     std::vector<Hole>& holes) {
  if (cell.kind == CellKind::missed) {
    holes.push_back({HoleKind::missed, test_case.id, mutant.name,
                     fmt::format("{} declares to catch '{}' with '{}' but {}", test_case.id, mutant.name,
                                 cell.declared, told(cell))});
  } else if (cell.kind == CellKind::wrong_cause) {
    const std::string declared =
        cell.declared.empty() ? "declares nothing about it" : fmt::format("declares '{}'", cell.declared);
    holes.push_back(
        {HoleKind::wrong_cause, test_case.id, mutant.name,
         fmt::format("{} on '{}' {}; the case {}", test_case.id, mutant.name, told(cell), declared)});
  }
}

void find_row_holes(const RoleMatrix& matrix, std::size_t row, std::vector<Hole>& holes) {
  const TestCase& test_case = *matrix.cases[row];
  const Cell& reference = matrix.reference[row];
  // A warn accuses nobody: it says what of the protocol users should know.
  const bool is_quiet = reference.verdict == Verdict::pass || reference.verdict == Verdict::warn ||
                        reference.kind == CellKind::not_applicable;
  if (!is_quiet && reference.kind != CellKind::not_run) {
    holes.push_back({HoleKind::false_alarm, test_case.id, "",
                     fmt::format("{} on the reference {}", test_case.id, told(reference))});
  }
  const std::vector<Cell>& cells = matrix.cells[row];
  for (std::size_t i = 0; i < cells.size(); ++i)
    find_cell_holes(test_case, *matrix.mutants[i], cells[i], holes);
  const bool catches =
      std::any_of(cells.begin(), cells.end(), [](const Cell& cell) { return cell.kind == CellKind::caught; });
  if (!catches) {
    holes.push_back({HoleKind::idle_case, test_case.id, "",
                     fmt::format("{} catches no mutant that it declares", test_case.id)});
  }
}

std::vector<Hole> find_holes(const Matrix& matrix) {
  std::vector<Hole> holes;
  for (const RoleMatrix& role : matrix.roles) {
    for (std::size_t column = 0; column < role.mutants.size(); ++column) {
      const bool is_caught =
          std::any_of(role.cells.begin(), role.cells.end(),
                      [&](const std::vector<Cell>& row) { return row[column].kind == CellKind::caught; });
      if (is_caught) continue;
      const Mutant& mutant = *role.mutants[column];
      holes.push_back({HoleKind::surviving_mutant, "", mutant.name,
                       fmt::format("no case catches the {} mutant '{}' for a declared reason ({})", role.role,
                                   mutant.name, mutant.description)});
    }
    for (std::size_t row = 0; row < role.cases.size(); ++row) find_row_holes(role, row, holes);
  }
  return holes;
}

}  // namespace

std::string_view name(CellKind kind) {
  constexpr std::array<std::string_view, 7> kNames = {
      "not-run", "not-applicable", "passed", "caught", "caught-undeclared", "missed", "wrong-cause"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::string_view name(HoleKind kind) {
  constexpr std::array<std::string_view, 5> kNames = {"surviving-mutant", "idle-case", "missed",
                                                      "wrong-cause", "false-alarm"};
  return kNames.at(static_cast<std::size_t>(kind));
}

Matrix make_matrix(const Suite& suite, const MatrixPlan& plan) {
  Matrix matrix;
  matrix.protocol = suite.protocol();
  matrix.seed = plan.seed;
  for (const std::string& role : suite.roles()) matrix.roles.push_back(blank_role(suite, role));
  const std::vector<PlannedRun> runs = planned_runs(matrix, plan.declared_only);

  OrderedWork<Cell> work;
  work.count = runs.size();
  work.threads = plan.jobs;
  work.stop = plan.stop;
  work.work = [&](std::size_t i) {
    const PlannedRun& run = runs[i];
    return run_cell(suite, *matrix.roles[run.role].cases[run.row], run.mutant, plan.seed);
  };
  work.deliver = [&](std::size_t i, Cell&& cell) {
    *runs[i].cell = std::move(cell);
    return true;
  };
  if (plan.on_progress) work.idle = [&](std::size_t finished) { plan.on_progress(finished, runs.size()); };
  matrix.is_complete = work.run() == runs.size();
  if (matrix.is_complete) matrix.holes = find_holes(matrix);
  return matrix;
}

}  // namespace fieldproof::conformance
