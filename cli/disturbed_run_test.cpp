// Subject: a plan whose declared faults and disturbances work together in the joined catalogue.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>
#include <variant>

#include "cli/probe/source_folder.hpp"
#include "cli/protocols.hpp"
#include "conformance/catalogue.hpp"
#include "conformance/runner.hpp"
#include "harness/kernel/error.hpp"
#include "reports/approved_text.hpp"

namespace fieldproof::cli {
namespace {

conformance::CaseRun run_under(const std::string& plan, std::uint64_t seed = 1) {
  static const conformance::Catalogue catalogue(built_in_suites());
  const auto entries = catalogue.select(std::vector<std::string>{"interbus/network/exchange/**"});
  conformance::Setup setup;
  setup.seed = seed;
  setup.volume = conformance::Volume::quick;
  setup.network_file = (kSourceFolder / "examples/paper.json").string();
  setup.plan_file = plan;
  return conformance::run_case(entries.front(), setup, {conformance::KeptRecordings::all});
}

const std::string kExample = (kSourceFolder / "examples/disturbed_line.plan.json").string();

// How often which fault stands in the trace.
std::map<std::string, int> faults_of(const conformance::CaseRun& done) {
  std::map<std::string, int> faults;
  for (const trace::Record& record : done.outcome.recording.trace.records) {
    if (const auto* fault = std::get_if<trace::Fault>(&record)) ++faults[fault->text];
  }
  return faults;
}

TEST(DisturbedRun, ShowsDeclaredFaultsAndDisturbancesInOneTrace) {
  const std::map<std::string, int> faults = faults_of(run_under(kExample));
  for (const auto& [text, count] : faults) SCOPED_TRACE(text + " " + std::to_string(count));
  EXPECT_GT(faults.contains("burst pulse") ? faults.at("burst pulse") : 0, 20);
  EXPECT_GE(faults.contains("flipped bit") ? faults.at("flipped bit") : 0, 5);
  EXPECT_EQ(faults.size(), 3U);
}

std::vector<std::string> places_of(const std::string& plan) {
  conformance::Setup setup;
  setup.plan_file = plan;
  std::vector<std::string> places;
  for (const fault::PlanPart& part : built_in_suites().front()->plan_parts(setup))
    places.push_back(part.place);
  return places;
}

TEST(DisturbedRun, CountsWhatEachPartOfThePlanDid) {
  EXPECT_EQ(places_of(kExample),
            (std::vector<std::string>{"/rules/0", "/disturbances/0", "/disturbances/1", "/disturbances/2"}));
  const conformance::CaseRun done = run_under(kExample);
  const std::vector<std::uint64_t>& hits = done.outcome.result.planned_hits;
  ASSERT_EQ(hits.size(), 4U);
  std::map<std::string, int> faults = faults_of(done);
  int lost = 0;
  for (const auto& [text, count] : faults)
    lost += text.find("misses a transmission") == text.npos ? 0 : count;
  EXPECT_GT(lost, 0);
  EXPECT_EQ(hits[0], static_cast<std::uint64_t>(lost));
  EXPECT_GT(hits[1], 10U);
  EXPECT_EQ(hits[3], 1U) << "five bits of one transmission";
}

TEST(DisturbedRun, TellsThatARuleNeverHit) {
  const reports::TemporaryFolder folder;
  const std::string plan = (folder.path() / "plan.json").string();
  std::ofstream(plan)
      << R"({"rules": [{"when": {"from": "1000 s"}, "scope": "transmission", "effect": {"drop": {}}}]})";
  const conformance::CaseRun done = run_under(plan);
  EXPECT_EQ(done.outcome.result.verdict, judge::Verdict::pass);
  EXPECT_EQ(done.outcome.result.planned_hits, std::vector<std::uint64_t>{0});
}

TEST(DisturbedRun, IsAFunctionOfItsSeed) {
  const auto fingerprint = [](const std::string& plan, std::uint64_t seed) {
    return run_under(plan, seed).outcome.result.fingerprint;
  };
  EXPECT_EQ(fingerprint(kExample, 1), fingerprint(kExample, 1));
  EXPECT_NE(fingerprint(kExample, 1), fingerprint(kExample, 2));
  EXPECT_NE(fingerprint(kExample, 1), fingerprint("", 1));
}

TEST(DisturbedRun, IsToldToRestOnAModelThatIsNotCalibrated) {
  conformance::Setup setup;
  const auto suite = std::move(built_in_suites().front());
  EXPECT_TRUE(suite->caveats(setup).empty());
  setup.plan_file = kExample;
  const std::vector<std::string> caveats = suite->caveats(setup);
  ASSERT_EQ(caveats.size(), 3U);
  EXPECT_NE(caveats.front().find("profile A (unshielded, not isolated) is a model of this project"),
            std::string::npos);
}

TEST(DisturbedRun, NamesAReceiverThatIsNotThere) {
  const reports::TemporaryFolder folder;
  const std::string plan = (folder.path() / "plan.json").string();
  std::ofstream(plan) << R"({"disturbances": [{"receiver": "slave@9/in", "bursts": {"level": 1}}]})";
  try {
    run_under(plan);
    FAIL();
  } catch (const kernel::Error& error) {
    EXPECT_TRUE(std::string(error.what())
                    .starts_with("/disturbances/0 of the plan: there is no receiver \"slave@9/in\" here; the "
                                 "nearest are \"slave@"))
        << error.what();
  }
}

}  // namespace
}  // namespace fieldproof::cli
