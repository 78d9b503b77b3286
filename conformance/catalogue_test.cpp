#include "conformance/catalogue.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "conformance/invented_case.hpp"
#include "conformance/suite_of_functions.hpp"
#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

Outcome pass(const TestCase&, const Setup&) {
  Outcome outcome;
  outcome.result.verdict = judge::Verdict::pass;
  return outcome;
}

Catalogue sample() {
  auto suite = std::make_unique<SuiteOfFunctions>("ring", std::vector<std::string>{"slave", "master"});
  suite->add({"swapped", "M1", "slave", "octets swapped"});
  suite->add({"late", "M2", "slave", "answers late"});
  suite->add({"late", "M3", "master", "polls late"});
  suite->add(invented_case("ring/slave/data/word_is_latched", {"must"}, {{"swapped", "wrong_word"}}), pass);
  suite->add(invented_case("ring/slave/data/word_is_held", {"must", "timing"}), pass);
  suite->add(invented_case("ring/slave/canary", {"canary", "must"}), pass);
  suite->add(invented_case("ring/master/poll/comes_first", {"timing"}), pass);
  std::vector<std::unique_ptr<Suite>> suites;
  suites.push_back(std::move(suite));
  return Catalogue(std::move(suites));
}

std::vector<std::string> selected(const Catalogue& catalogue, std::vector<std::string> selectors) {
  std::vector<std::string> ids;
  for (const Entry& entry : catalogue.select(selectors)) ids.push_back(entry.test_case->id);
  return ids;
}

std::string refusal(const std::function<void()>& request) {
  try {
    request();
  } catch (const kernel::Error& error) {
    EXPECT_EQ(error.kind(), kernel::ErrorKind::usage);
    return error.what();
  }
  ADD_FAILURE() << "the request was served";
  return {};
}

const std::vector<std::string> kAllButCanary = {
    "ring/slave/data/word_is_latched", "ring/slave/data/word_is_held", "ring/master/poll/comes_first"};

TEST(Catalogue, WithoutSelectorTakesAllButTheCanary) {
  const Catalogue catalogue = sample();
  EXPECT_EQ(selected(catalogue, {}), kAllButCanary);
  EXPECT_EQ(selected(catalogue, {"**"}), kAllButCanary);
  EXPECT_EQ(selected(catalogue, {"ring/**"}), kAllButCanary);
}

TEST(Catalogue, CanaryIsSelectedByNameOrByItsTagOnly) {
  const Catalogue catalogue = sample();
  const std::vector<std::string> canary = {"ring/slave/canary"};
  EXPECT_EQ(selected(catalogue, {"ring/slave/canary"}), canary);
  EXPECT_EQ(selected(catalogue, {"+canary"}), canary);
  EXPECT_THROW(selected(catalogue, {"ring/slave/cana*"}), kernel::Error);
  EXPECT_EQ(selected(catalogue, {"+must"}).size(), 2U);
}

TEST(Catalogue, SelectsUnionsInItsOwnOrderWithoutRepetition) {
  const Catalogue catalogue = sample();
  EXPECT_EQ(selected(catalogue, {"ring/master/**", "+timing", "ring/slave/data/*"}), kAllButCanary);
}

TEST(Catalogue, ExclusionTakesAwayWhateverItsPlace) {
  const Catalogue catalogue = sample();
  const std::vector<std::string> latched = {"ring/slave/data/word_is_latched"};
  EXPECT_EQ(selected(catalogue, {"!+timing"}), latched);
  EXPECT_EQ(selected(catalogue, {"!+timing", "ring/slave/**"}), latched);
}

TEST(Catalogue, UnmatchedSelectorNamesTheNearestIds) {
  const Catalogue catalogue = sample();
  const std::string id = refusal([&] { selected(catalogue, {"ring/slave/data/word_is_latch"}); });
  EXPECT_NE(id.find("nearest are 'ring/slave/data/word_is_latched', 'ring/slave/data/word_is_held'"),
            std::string::npos)
      << id;
  const std::string folder = refusal([&] { selected(catalogue, {"ring/slave"}); });
  EXPECT_NE(folder.find("'ring/slave/**'"), std::string::npos) << folder;
  const std::string tag = refusal([&] { selected(catalogue, {"+mus"}); });
  EXPECT_NE(tag.find("nearest are '+must'"), std::string::npos) << tag;
  const std::string exclusion = refusal([&] { selected(catalogue, {"!+nothing"}); });
  EXPECT_NE(exclusion.find("'!+nothing' matches no test case"), std::string::npos) << exclusion;
}

TEST(Catalogue, UnknownCaseNamesTheNearest) {
  const Catalogue catalogue = sample();
  EXPECT_EQ(catalogue.at("ring/slave/canary").test_case->id, "ring/slave/canary");
  const std::string sentence = refusal([&] { catalogue.at("ring/slave/canari"); });
  EXPECT_NE(sentence.find("nearest are 'ring/slave/canary'"), std::string::npos) << sentence;
}

TEST(Catalogue, UnknownProtocolNamesTheOthers) {
  const Catalogue catalogue = sample();
  EXPECT_EQ(catalogue.suite("ring").protocol(), "ring");
  EXPECT_NE(refusal([&] { catalogue.suite("rung"); }).find("there are those of 'ring'"), std::string::npos);
}

TEST(Catalogue, MutantIsFoundByAnyUniquePartOfItsPath) {
  const Catalogue catalogue = sample();
  EXPECT_EQ(catalogue.mutant("swapped").mutant->label, "M1");
  EXPECT_EQ(catalogue.mutant("master/late").mutant->label, "M3");
  EXPECT_EQ(catalogue.mutant("ring/slave/late").mutant->label, "M2");
  const std::string twice = refusal([&] { catalogue.mutant("late"); });
  EXPECT_NE(twice.find("'ring/slave/late', 'ring/master/late'"), std::string::npos) << twice;
  const std::vector<std::string> masters = {"ring/master/**"};
  EXPECT_EQ(catalogue.mutant("late", catalogue.select(masters)).mutant->label, "M3");
  const std::string unknown = refusal([&] { catalogue.mutant("swaped"); });
  EXPECT_NE(unknown.find("nearest are 'swapped'"), std::string::npos) << unknown;
}

TEST(Catalogue, BrokenSuitesAreFoundAtOnce) {
  const auto make = [](TestCase first, TestCase second) {
    auto suite = std::make_unique<SuiteOfFunctions>("ring", std::vector<std::string>{"slave"});
    suite->add(std::move(first), pass);
    suite->add(std::move(second), pass);
    std::vector<std::unique_ptr<Suite>> suites;
    suites.push_back(std::move(suite));
    return Catalogue(std::move(suites));
  };
  EXPECT_NO_THROW(make(invented_case("ring/slave/a"), invented_case("ring/slave/b")));
  EXPECT_THROW(make(invented_case("ring/slave/a"), invented_case("ring/slave/a")), kernel::BrokenInvariant);
  EXPECT_THROW(make(invented_case("ring/slave/a"), invented_case("bus/slave/b")), kernel::BrokenInvariant);
  EXPECT_THROW(make(invented_case("ring/slave/a"), invented_case("ring/master/b")), kernel::BrokenInvariant);
  EXPECT_THROW(make(invented_case("ring/slave/a"), invented_case("ring/slave/b", {}, {{"unknown", "x"}})),
               kernel::BrokenInvariant);
}

}  // namespace
}  // namespace fieldproof::conformance
