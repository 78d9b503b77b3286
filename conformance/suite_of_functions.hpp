// A suite whose cases are functions: what the tests of the bench itself run, and a protocol's suite before it
// has a bench. Mutants are names only; a function looks at the setup and decides.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "conformance/running_case.hpp"
#include "conformance/suite.hpp"

namespace fieldproof::conformance {

class SuiteOfFunctions : public Suite {
 public:
  using Function = std::function<Outcome(const TestCase&, const Setup&)>;

  SuiteOfFunctions(std::string protocol, const std::vector<std::string>& roles)
      : Suite(rows_of(std::move(protocol), roles)) {}

  // Of one of the roles.
  void add(TestCase test_case, Function function) {
    RoleRow& row = role(test_case.role());
    row.run = [id = test_case.id, function = std::move(function), others = std::move(row.run)](
                  const TestCase& one, RunningCase& run) {
      if (one.id != id) return others(one, run);
      Outcome outcome = function(one, run.setup());
      outcome.result.id = one.id;
      outcome.result.purpose = one.purpose;
      outcome.result.requirement = one.requirement;
      outcome.result.reference = one.reference;
      return outcome;
    };
    add_case(std::move(test_case));
  }
  void add(Mutant mutant) { add_mutant(std::move(mutant)); }
  void add(judge::PicsItem item) { rows().roles.front().pics_items.push_back(std::move(item)); }
  void set_last_position(int position) { rows().last_position = position; }

 private:
  static SuiteRows rows_of(std::string protocol, const std::vector<std::string>& roles) {
    SuiteRows rows{.protocol = std::move(protocol), .roles = {}};
    for (const std::string& name : roles) rows.roles.push_back({.name = name});
    return rows;
  }
};

}  // namespace fieldproof::conformance
