// A suite whose cases are functions: what the tests of the bench itself run, and a protocol's suite before it
// has a network. Mutants are names only; a function looks at the setup and decides.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/test_case.hpp"

namespace fieldproof::conformance {

class SuiteOfFunctions : public Suite {
 public:
  using Function = std::function<Outcome(const TestCase&, const Setup&)>;

  SuiteOfFunctions(std::string protocol, std::vector<std::string> roles)
      : protocol_(std::move(protocol)), roles_(std::move(roles)) {}

  void add(TestCase test_case, Function function) {
    functions_[test_case.id] = std::move(function);
    cases_.push_back(std::move(test_case));
  }
  void add(Mutant mutant) { mutants_.push_back(std::move(mutant)); }
  void add(judge::PicsItem item) { pics_items_.push_back(std::move(item)); }
  // The functions know the URI `own` in this role.
  void add_own(std::string role) { own_roles_.insert(std::move(role)); }
  void set_last_position(int position) { last_position_ = position; }

  std::string_view protocol() const override { return protocol_; }
  std::vector<std::string> roles() const override { return roles_; }
  bool has_own(std::string_view role) const override { return own_roles_.contains(role); }
  const std::vector<TestCase>& cases() const override { return cases_; }
  const std::vector<Mutant>& mutants() const override { return mutants_; }

  int last_position() const override { return last_position_; }
  std::vector<judge::PicsItem> pics_items() const override { return pics_items_; }

  Outcome run(const TestCase& test_case, const Setup& setup) const override {
    Outcome outcome = functions_.at(test_case.id)(test_case, setup);
    outcome.result.id = test_case.id;
    outcome.result.purpose = test_case.purpose;
    outcome.result.requirement = test_case.requirement;
    outcome.result.reference = test_case.reference;
    return outcome;
  }

 private:
  std::string protocol_;
  std::vector<std::string> roles_;
  std::vector<TestCase> cases_;
  std::vector<Mutant> mutants_;
  std::vector<judge::PicsItem> pics_items_;
  std::set<std::string, std::less<>> own_roles_;
  int last_position_ = 1;
  std::map<std::string, Function, std::less<>> functions_;
};

}  // namespace fieldproof::conformance
