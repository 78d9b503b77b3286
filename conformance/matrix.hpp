// Cases x mutants: what each test case says about each mutant of its role, and the holes of the suite.
//
// Every case of a role is run on the reference and on each mutant of that role, at Volume::quick. A
// mutant counts as caught only by a case that declares it and fails with the declared reason: a failure
// for another reason proves nothing about the case's purpose.
//
// Contract: the same matrix for one seed, whatever the number of jobs. Canaries are left out: they fail by
// design. A mutant column costs one run per case of the role; of derived cases, which are many in one, only
// those are run that declare to catch it. kernel::Error of the suite passes through.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/suite.hpp"
#include "conformance/test_case.hpp"

namespace fieldproof::conformance {

enum class CellKind : std::uint8_t {
  not_run,         // the matrix was stopped before, or declared catches alone were asked for and this is none
  not_applicable,  // the case does not apply to this implementation
  passed,          // not caught, and not declared to be
  caught,          // fails for the declared reason
  caught_undeclared,  // fails, without being declared
  missed,             // declared, but does not fail
  wrong_cause,        // declared, but fails for another reason; or the verdict is error
};

std::string_view name(CellKind kind);

struct Cell {
  CellKind kind = CellKind::not_run;
  judge::Verdict verdict = judge::Verdict::none;
  std::string reason;    // of the result
  std::string declared;  // reason that the case declares, empty when it declares nothing
};

enum class HoleKind : std::uint8_t {
  surviving_mutant,
  idle_case,    // catches nothing
  missed,       // a declared catch does not happen
  wrong_cause,  // a declared catch happens for another reason, or the case ends in an error
  false_alarm,  // the reference neither passes nor warns
};

std::string_view name(HoleKind kind);

struct Hole {
  HoleKind kind = HoleKind::missed;
  std::string case_id;  // empty for an uncaught mutant
  std::string mutant;   // empty for an idle case and a false alarm
  std::string sentence;
};

// The cases and mutants of one role. cells[c][d] belongs to cases[c] and mutants[d].
struct RoleMatrix {
  std::string role;
  std::vector<const TestCase*> cases;
  std::vector<const Mutant*> mutants;
  std::vector<Cell> reference;
  std::vector<std::vector<Cell>> cells;
};

struct Matrix {
  std::string protocol;
  std::uint64_t seed = 1;
  std::vector<RoleMatrix> roles;
  std::vector<Hole> holes;
  bool is_complete = true;
};

struct MatrixPlan {
  std::uint64_t seed = 1;
  unsigned jobs = 1;
  // Of the mutants only those are run that a case declares to catch: no hole is overlooked but that of a case
  // that ends in an error on a mutant that it does not name.
  bool declared_only = false;
  std::stop_token stop;
  // Finished and planned runs, a few times a second.
  std::function<void(std::size_t, std::size_t)> on_progress;
};

Matrix make_matrix(const Suite& suite, const MatrixPlan& plan);

}  // namespace fieldproof::conformance
