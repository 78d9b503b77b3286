#include "conformance/matrix.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "conformance/suite_of_functions.hpp"

namespace fieldproof::conformance {
namespace {

using judge::Verdict;

// What a case answers to each uri; what is not listed passes.
using Answers = std::map<std::string, std::pair<Verdict, std::string>>;

SuiteOfFunctions::Function answering(Answers answers) {
  return [answers = std::move(answers)](const TestCase&, const conformance::Setup& setup) {
    EXPECT_EQ(setup.volume, Volume::quick);
    Outcome outcome;
    outcome.result.verdict = Verdict::pass;
    const auto found = answers.find(setup.implementations.at(0).uri);
    if (found != answers.end()) std::tie(outcome.result.verdict, outcome.result.reason) = found->second;
    return outcome;
  };
}

TestCase declaring(std::string name, std::vector<MustCatch> catches, std::vector<std::string> tags = {}) {
  TestCase test_case;
  test_case.id = "ring/slave/" + name;
  test_case.catches = std::move(catches);
  test_case.tags = std::move(tags);
  return test_case;
}

class MatrixOfARing : public testing::Test {
 protected:
  MatrixOfARing() : suite_("ring", {"slave"}) {
    suite_.add({"swapped", "M1", "slave", "octets swapped"});
    suite_.add({"late", "M2", "slave", "answers late"});
  }

  std::vector<std::string> holes(unsigned jobs = 1) {
    std::vector<std::string> found;
    MatrixPlan plan;
    plan.jobs = jobs;
    for (const Hole& hole : make_matrix(suite_, plan).holes) {
      found.push_back(std::string(name(hole.kind)) + " " + hole.case_id + " " + hole.mutant);
    }
    return found;
  }

  void add_good_cases() {
    suite_.add(declaring("word", {{"swapped", "wrong_word"}}),
               answering({{"mutant:swapped", {Verdict::fail, "wrong_word"}}}));
    suite_.add(declaring("time", {{"late", "late_answer"}}),
               answering({{"mutant:late", {Verdict::fail, "late_answer"}}}));
  }

  using Strings = std::vector<std::string>;
  SuiteOfFunctions suite_;
};

TEST_F(MatrixOfARing, WithoutAHole) {
  add_good_cases();
  EXPECT_EQ(holes(), Strings{});
  const Matrix matrix = make_matrix(suite_, {});
  ASSERT_EQ(matrix.roles.size(), 1U);
  EXPECT_EQ(matrix.roles[0].cells[0][0].kind, CellKind::caught);
  EXPECT_EQ(matrix.roles[0].cells[0][1].kind, CellKind::passed);
  EXPECT_EQ(matrix.roles[0].reference[0].verdict, Verdict::pass);
}

TEST_F(MatrixOfARing, CanaryTakesNoPart) {
  add_good_cases();
  suite_.add(declaring("canary", {}, {"canary"}), answering({{"ref", {Verdict::fail, "canary"}}}));
  EXPECT_EQ(holes(), Strings{});
}

TEST_F(MatrixOfARing, SurvivingMutantIsAHole) {
  suite_.add(declaring("word", {{"swapped", "wrong_word"}}),
             answering({{"mutant:swapped", {Verdict::fail, "wrong_word"}}}));
  EXPECT_EQ(holes(), Strings{"surviving-mutant  late"});
}

TEST_F(MatrixOfARing, UndeclaredCatchDoesNotFillAHole) {
  suite_.add(declaring("word", {{"swapped", "wrong_word"}}),
             answering({{"mutant:swapped", {Verdict::fail, "wrong_word"}},
                        {"mutant:late", {Verdict::fail, "wrong_word"}}}));
  EXPECT_EQ(make_matrix(suite_, {}).roles[0].cells[0][1].kind, CellKind::caught_undeclared);
  EXPECT_EQ(holes(), Strings{"surviving-mutant  late"});
}

TEST_F(MatrixOfARing, OfDeclaredCatchesAloneHasTheSameHoles) {
  suite_.add(declaring("word", {{"swapped", "wrong_word"}}),
             answering({{"mutant:late", {Verdict::fail, "wrong_word"}}}));
  suite_.add(declaring("idle", {}), answering({}));
  const Strings of_all = holes();
  const Matrix matrix = make_matrix(suite_, {.declared_only = true, .stop = {}, .on_progress = {}});
  EXPECT_EQ(matrix.holes.size(), of_all.size());
  EXPECT_EQ(of_all.size(), 5U);  // two that survive, a catch that is missed, two idle cases
  EXPECT_EQ(matrix.roles[0].cells[0][0].kind, CellKind::missed);
  EXPECT_EQ(matrix.roles[0].cells[0][1].kind, CellKind::not_run);
  EXPECT_EQ(matrix.roles[0].reference[1].verdict, Verdict::pass);
}

TEST_F(MatrixOfARing, CaseThatCatchesNothingIsAHole) {
  add_good_cases();
  suite_.add(declaring("idle", {}), answering({{"mutant:late", {Verdict::fail, "late_answer"}}}));
  EXPECT_EQ(holes(), Strings{"idle-case ring/slave/idle "});
}

TEST_F(MatrixOfARing, DeclaredCatchThatDoesNotHappenIsAHole) {
  add_good_cases();
  suite_.add(
      declaring("more", {{"swapped", "x"}, {"late", "y"}}),
      answering({{"mutant:swapped", {Verdict::fail, "x"}}, {"mutant:late", {Verdict::inconclusive, "y"}}}));
  EXPECT_EQ(holes(), Strings{"missed ring/slave/more late"});
}

TEST_F(MatrixOfARing, WrongCauseIsAHole) {
  add_good_cases();
  suite_.add(declaring("more", {{"swapped", "x"}, {"late", "y"}}),
             answering({{"mutant:swapped", {Verdict::fail, "x"}}, {"mutant:late", {Verdict::fail, "z"}}}));
  EXPECT_EQ(holes(), Strings{"wrong-cause ring/slave/more late"});
}

TEST_F(MatrixOfARing, ErrorOfTheBenchIsAWrongCauseEvenUndeclared) {
  add_good_cases();
  suite_.add(declaring("more", {{"swapped", "x"}}),
             [](const TestCase&, const conformance::Setup& setup) -> Outcome {
               if (setup.implementations[0].uri == "mutant:late") throw std::runtime_error("lost");
               Outcome outcome;
               const bool is_swapped = setup.implementations[0].uri == "mutant:swapped";
               outcome.result.verdict = is_swapped ? Verdict::fail : Verdict::pass;
               outcome.result.reason = is_swapped ? "x" : "";
               return outcome;
             });
  EXPECT_EQ(holes(), Strings{"wrong-cause ring/slave/more late"});
}

TEST_F(MatrixOfARing, FalseAlarmOnTheReferenceIsAHole) {
  add_good_cases();
  suite_.add(declaring("nervous", {{"late", "y"}}),
             answering({{"mutant:late", {Verdict::fail, "y"}}, {"ref", {Verdict::inconclusive, "y"}}}));
  EXPECT_EQ(holes(), Strings{"false-alarm ring/slave/nervous "});
}

TEST_F(MatrixOfARing, AWarnOnTheReferenceIsNone) {
  add_good_cases();
  suite_.add(declaring("tells", {{"late", "y"}}),
             answering({{"mutant:late", {Verdict::fail, "y"}}, {"ref", {Verdict::warn, "weak"}}}));
  EXPECT_EQ(holes(), Strings{});
}

TEST_F(MatrixOfARing, DeclaredReasonMayBeAnyFailingFinding) {
  add_good_cases();
  suite_.add(declaring("two", {{"late", "second"}}), [](const TestCase&, const conformance::Setup& setup) {
    Outcome outcome;
    outcome.result.verdict = Verdict::pass;
    if (setup.implementations[0].uri == "mutant:late") {
      outcome.result.verdict = Verdict::fail;
      outcome.result.reason = "first";
      outcome.result.findings.resize(2);
      outcome.result.findings[1].reason = "second";
    }
    return outcome;
  });
  EXPECT_EQ(holes(), Strings{});
}

TEST_F(MatrixOfARing, ThreadsMakeTheSameMatrix) {
  add_good_cases();
  suite_.add(declaring("idle", {}), answering({}));
  EXPECT_EQ(holes(1), holes(4));
}

TEST_F(MatrixOfARing, StoppedIsIncompleteAndClaimsNoHoles) {
  add_good_cases();
  std::stop_source source;
  source.request_stop();
  MatrixPlan plan;
  plan.stop = source.get_token();
  const Matrix matrix = make_matrix(suite_, plan);
  EXPECT_FALSE(matrix.is_complete);
  EXPECT_TRUE(matrix.holes.empty());
  EXPECT_EQ(matrix.roles[0].reference[0].kind, CellKind::not_run);
}

}  // namespace
}  // namespace fieldproof::conformance
