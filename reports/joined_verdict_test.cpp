#include "reports/joined_verdict.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "reports/sample_page.hpp"

namespace fieldproof::reports {
namespace {

using judge::Verdict;
using OrderedJson = nlohmann::ordered_json;

PageRun run_of(const std::string& name, const std::vector<Verdict>& verdicts) {
  PageRun run;
  run.name = name;
  for (const Verdict verdict : verdicts) {
    run.stored.run.cases.push_back(
        sample_case("case_" + std::to_string(run.stored.run.cases.size()), verdict));
  }
  run.stored.run.identity.selected = verdicts.size();
  return run;
}

JoinedVerdict of_document(const OrderedJson& document) {
  PageContent content;
  content.runs = {run_of("good", {Verdict::pass})};
  content.documents = {{"document.json", document.dump()}};
  return joined_verdict(content);
}

OrderedJson quiet_emc() {
  OrderedJson emc = sample_emc();
  for (OrderedJson& test : emc["tests"]) {
    test["came_up"] = true;
    test["criterion"] = "A";
    test["bus_stops"] = 0;
  }
  return emc;
}

TEST(JoinedVerdict, TheWorstRunIsTheHeadlineWhereverItStands) {
  PageContent content;
  content.runs = {run_of("good", {Verdict::pass, Verdict::pass}),
                  run_of("bad", {Verdict::pass, Verdict::fail, Verdict::fail})};
  const JoinedVerdict joined = joined_verdict(content);
  EXPECT_EQ(joined.verdict, Verdict::fail);
  EXPECT_EQ(joined.sentence, "2 runs: 1 failed (2 of 5 judged cases failed)");
  EXPECT_EQ(joined.runs[0], (JudgedPart{"good", Verdict::pass, "all 2 judged cases passed"}));
  EXPECT_EQ(joined.runs[1], (JudgedPart{"bad", Verdict::fail, "2 of 3 judged cases failed"}));
}

TEST(JoinedVerdict, WhatIsIncompleteOrJudgedNothingIsNoPass) {
  PageRun killed = run_of("killed", {Verdict::pass});
  killed.stored.run.identity.selected = 3;
  killed.stored.run.identity.incomplete_because = "killed";
  PageContent content;
  content.runs = {killed};
  EXPECT_EQ(joined_verdict(content).verdict, Verdict::inconclusive);
  EXPECT_EQ(joined_verdict(content).sentence,
            "all 1 judged case passed; the run is incomplete: 2 of 3 selected cases have no verdict");
  content.runs = {run_of("empty", {}), run_of("good", {Verdict::pass})};
  EXPECT_EQ(joined_verdict(content).verdict, Verdict::inconclusive);
  content.runs = {run_of("open", {Verdict::pass, Verdict::inconclusive})};
  EXPECT_EQ(joined_verdict(content).sentence, "1 of 2 judged cases could not be told; none failed");
}

TEST(JoinedVerdict, AnExpectedFailurePassesAndAStrictRunDoesNot) {
  PageRun run = run_of("run", {Verdict::pass, Verdict::fail});
  run.stored.run.cases[1].expected_because = "known";
  PageContent content;
  content.runs = {run};
  EXPECT_EQ(joined_verdict(content).verdict, Verdict::pass);
  EXPECT_EQ(joined_verdict(content).sentence,
            "all 2 judged cases passed, or failed as the baseline expects (1 as expected)");
  content.runs = {run_of("strict", {Verdict::warn})};
  EXPECT_EQ(joined_verdict(content).verdict, Verdict::warn);
  content.runs[0].stored.run.identity.exit_code = 1;
  EXPECT_EQ(joined_verdict(content).verdict, Verdict::fail);
  content.runs[0].stored.run.identity.exit_code = 70;
  EXPECT_EQ(joined_verdict(content).verdict, Verdict::error);
}

TEST(JoinedVerdict, BurstsSayThatTheBusStopped) {
  EXPECT_EQ(of_document(quiet_emc()).verdict, Verdict::pass);
  OrderedJson emc = quiet_emc();
  emc["tests"][3]["criterion"] = "B";
  EXPECT_EQ(of_document(emc).verdict, Verdict::warn);
  emc["tests"][4]["bus_stops"] = 2;
  EXPECT_EQ(of_document(emc).verdict, Verdict::fail);
  EXPECT_EQ(of_document(emc).sentence, "all 1 judged case passed; the bus stopped in 1 of 16 burst tests");
  emc["tests"][5]["criterion"] = "D";
  EXPECT_EQ(of_document(emc).documents[0].sentence,
            "the bus stopped in 1 of 16 burst tests, criterion D in 1 of 16 burst tests");
  emc = quiet_emc();
  emc["is_complete"] = false;
  EXPECT_EQ(of_document(emc).verdict, Verdict::inconclusive);
  emc = quiet_emc();
  emc["tests"][0]["came_up"] = false;
  EXPECT_EQ(of_document(emc).verdict, Verdict::inconclusive);
  emc = quiet_emc();
  emc["channels"][0]["chance_of_count"] = 1e-6;
  EXPECT_EQ(of_document(emc).verdict, Verdict::fail);
}

TEST(JoinedVerdict, BurstsThatMetNoReceiverAndChannelsThatStoppedAreNoPass) {
  OrderedJson emc = quiet_emc();
  emc["tests"][0]["evidence"]["text"] = "";
  EXPECT_EQ(of_document(emc).verdict, Verdict::inconclusive);
  EXPECT_EQ(of_document(emc).documents[0].sentence, "no burst met a receiver in 1 of 16 burst tests");
  emc = quiet_emc();
  emc["channels"][0]["bus_stops"] = 14;
  EXPECT_EQ(of_document(emc).verdict, Verdict::fail);
  emc = quiet_emc();
  emc["channels"][0]["ledger"]["sent"] = 20;
  EXPECT_EQ(of_document(emc).verdict, Verdict::inconclusive);
}

// It has accepted nothing wrong, and no burst has to have met anybody.
TEST(JoinedVerdict, AnImplementationThatEndsATestIsSaidToHave) {
  OrderedJson emc = quiet_emc();
  emc["tests"][0]["criterion"] = "D";
  emc["tests"][0]["complaint"] = "implementation_hangs: it has not answered within 2000 ms";
  emc["tests"][0]["evidence"]["text"] = "";
  EXPECT_EQ(of_document(emc).verdict, Verdict::fail);
  EXPECT_EQ(of_document(emc).documents[0].sentence,
            "an implementation crashed, hung or broke its contract in 1 of 16 burst tests");
  emc = quiet_emc();
  emc["channels"][0]["complaint"] = "implementation_crashed: it ended";
  emc["channels"][0]["ledger"]["sent"] = 0;
  EXPECT_EQ(of_document(emc).verdict, Verdict::fail);
  EXPECT_EQ(of_document(emc).documents[0].sentence.find(
                "an implementation crashed, hung or broke its contract on 1 of"),
            0U);
}

TEST(JoinedVerdict, AMeasurementThatWasNeverQuietTestsNoTheory) {
  OrderedJson measurement = OrderedJson::parse(measurement_json(sample_measurement()));
  measurement["failures"] = OrderedJson::array();
  measurement["agreement"] = "open";
  for (OrderedJson& series : measurement["series"])
    for (OrderedJson& one : series["comparisons"]) one["phase"] = "burst";
  EXPECT_EQ(of_document(measurement).verdict, Verdict::inconclusive);
  EXPECT_EQ(of_document(measurement).documents[0].sentence,
            "nothing was measured while the network was quiet, so no theory was tested");
}

TEST(JoinedVerdict, OtherDocumentsCountAsWell) {
  OrderedJson measurement = OrderedJson::parse(measurement_json(sample_measurement()));
  for (const auto& [agreement, verdict] :
       {std::pair("holds", Verdict::pass), std::pair("open", Verdict::inconclusive),
        std::pair("differs", Verdict::fail)}) {
    measurement["agreement"] = agreement;
    measurement["failures"] = OrderedJson::array();
    EXPECT_EQ(of_document(measurement).verdict, verdict) << agreement;
  }
  // The theory is that of references: another station may be faster or slower.
  measurement["implementations"] = "node@3=exec:./node";
  EXPECT_EQ(of_document(measurement).verdict, Verdict::inconclusive);
  measurement["agreement"] = "holds";
  measurement["failures"] = {"50 Hz: the bus stopped for good"};
  EXPECT_EQ(of_document(measurement).documents[0].sentence,
            "the measurement failed: 50 Hz: the bus stopped for good");
  OrderedJson matrix = sample_matrix();
  EXPECT_EQ(of_document(matrix).verdict, Verdict::fail);
  matrix["holes"][0]["kind"] = "surviving-mutant";
  EXPECT_EQ(of_document(matrix).documents[0].sentence, "1 mutant survives");
  matrix["holes"] = OrderedJson::array();
  EXPECT_EQ(of_document(matrix).verdict, Verdict::pass);
  matrix["complete"] = false;
  EXPECT_EQ(of_document(matrix).verdict, Verdict::inconclusive);
  OrderedJson publication = OrderedJson::parse(publication_json(sample_publication()));
  EXPECT_EQ(of_document(publication).verdict, Verdict::pass);
  publication["rows"]["DIFFERS"] = 1;
  EXPECT_EQ(of_document(publication).verdict, Verdict::fail);
  OrderedJson fit = sample_fit("network");
  EXPECT_EQ(of_document(fit).documents[0].sentence, "the counts of 12 conditions follow the burst model");
  EXPECT_EQ(of_document(fit).verdict, Verdict::pass);
  fit["verdict"] = "open";
  EXPECT_EQ(of_document(fit).verdict, Verdict::inconclusive);
  fit["verdict"] = "contradicts";
  EXPECT_EQ(of_document(fit).verdict, Verdict::fail);
  EXPECT_EQ(of_document(sample_campaign("title")).verdict, Verdict::fail);
  EXPECT_EQ(of_document(sample_residual()).verdict, Verdict::pass) << "it has no verdict";
}

TEST(JoinedVerdict, ASearchOfFuzzCountsAsItEnded) {
  OrderedJson fuzz = sample_fuzz("ref");
  EXPECT_EQ(of_document(fuzz).verdict, Verdict::fail);
  EXPECT_EQ(of_document(fuzz).documents[0].sentence,
            "fuzzing valve_bus/node found write_not_taken in sequence 341");
  fuzz["found"]["is_confirmed"] = false;
  EXPECT_EQ(of_document(fuzz).verdict, Verdict::inconclusive);
  fuzz.erase("found");
  EXPECT_EQ(of_document(fuzz).documents[0].sentence,
            "1 of 341 sequences of fuzzing valve_bus/node could not be told; none failed");
  EXPECT_EQ(of_document(fuzz).verdict, Verdict::inconclusive);
  fuzz["inconclusive"] = 0;
  EXPECT_EQ(of_document(fuzz).verdict, Verdict::pass) << "--max-time ends a search as its user asked for";
  EXPECT_EQ(of_document(fuzz).documents[0].sentence, "no finding in 341 sequences of fuzzing valve_bus/node");
  fuzz["has_coverage"] = false;
  EXPECT_NE(of_document(fuzz).documents[0].sentence.find("without coverage"), std::string::npos);
  fuzz["silent"] = fuzz["passed"];
  EXPECT_EQ(of_document(fuzz).verdict, Verdict::inconclusive);
  fuzz["passed"] = 0;
  EXPECT_EQ(of_document(fuzz).verdict, Verdict::inconclusive);
  fuzz["passed"] = 340;
  fuzz["silent"] = 0;
  fuzz["is_interrupted"] = true;
  EXPECT_EQ(of_document(fuzz).verdict, Verdict::inconclusive);
}

TEST(JoinedVerdict, APageOfNumbersAloneIsNoPass) {
  PageContent content;
  content.documents = {{"residual.json", sample_residual().dump()}};
  EXPECT_EQ(joined_verdict(content).verdict, Verdict::none);
  EXPECT_EQ(joined_verdict({}).verdict, Verdict::none);
}

TEST(JoinedVerdict, OfTwoRunsThatAreComparedTheSecondCounts) {
  PageContent content;
  content.is_comparison = true;
  content.runs = {run_of("before", {Verdict::fail, Verdict::pass}),
                  run_of("after", {Verdict::pass, Verdict::pass})};
  EXPECT_EQ(joined_verdict(content).verdict, Verdict::pass);
  EXPECT_EQ(joined_verdict(content).sentence, "all 2 judged cases passed; since before: 1 case is fixed");
  std::swap(content.runs[0], content.runs[1]);
  EXPECT_EQ(joined_verdict(content).verdict, Verdict::fail);
  EXPECT_EQ(joined_verdict(content).sentence, "1 of 2 judged cases failed; since after: 1 new failure");
  content.runs[1] = run_of("less", {Verdict::pass});
  EXPECT_EQ(joined_verdict(content).verdict, Verdict::inconclusive) << "a case is gone";
}

TEST(JoinedVerdict, EachCaveatIsSaidOnce) {
  PageContent content;
  content.runs = {run_of("a", {Verdict::pass}), run_of("b", {Verdict::pass})};
  content.runs[0].stored.run.identity.caveats = {"one", "two"};
  content.runs[1].stored.run.identity.caveats = {"two"};
  const std::vector<JoinedCaveat> expected = {{"one", {"a"}}, {"two", {"a", "b"}}};
  EXPECT_EQ(joined_verdict(content).caveats, expected);
}

TEST(JoinedVerdict, VerdictsOfUnverifiedSourcesAreCountedOnce) {
  PageContent content;
  content.runs = {run_of("a", {Verdict::pass, Verdict::fail}), run_of("b", {Verdict::pass, Verdict::none})};
  const auto unverify = [&content](std::size_t run, std::size_t at) {
    content.runs[run].stored.run.cases[at].reference.standing = judge::Standing::own;
  };
  EXPECT_TRUE(joined_verdict(content).caveats.empty());
  unverify(1, 1);
  EXPECT_TRUE(joined_verdict(content).caveats.empty()) << "it has no verdict";
  unverify(0, 1);
  const std::vector<JoinedCaveat> one = {
      {"1 of these 3 verdicts (33 %) rest on an unverified source", {"a"}}};
  EXPECT_EQ(joined_verdict(content).caveats, one);
  unverify(1, 0);
  const std::vector<JoinedCaveat> both = {
      {"2 of these 3 verdicts (67 %) rest on an unverified source", {"a", "b"}}};
  EXPECT_EQ(joined_verdict(content).caveats, both);
  content.is_comparison = true;
  const std::vector<JoinedCaveat> second = {
      {"1 of these 1 verdicts (100 %) rest on an unverified source", {"b"}}};
  EXPECT_EQ(joined_verdict(content).caveats, second);
}

// As they are written now, and as conditions of documents of before.
TEST(JoinedVerdict, CaveatsOfAMeasurementAreSaid) {
  OrderedJson measurement = OrderedJson::parse(measurement_json(sample_burst_measurement()));
  const std::vector<JoinedCaveat> expected = {{"The coupling is not calibrated.", {"document.json"}}};
  EXPECT_EQ(of_document(measurement).caveats, expected);
  measurement.erase("unverified");
  EXPECT_TRUE(of_document(measurement).caveats.empty());
  measurement["conditions"].push_back({{"name", "unverified"}, {"value", expected[0].text}});
  EXPECT_EQ(of_document(measurement).caveats, expected);
}

TEST(JoinedVerdict, SequencesAgainstMutantsCountAsTheirVerb) {
  OrderedJson detection = sample_detection("node");
  EXPECT_EQ(of_document(detection).documents[0].sentence,
            "random sequences find a mutant in 3 of 6 trials (50.0 %)");
  EXPECT_EQ(of_document(detection).verdict, Verdict::fail);
  detection["roles"][0]["complete"] = false;
  EXPECT_EQ(of_document(detection).verdict, Verdict::inconclusive);
  detection["roles"][0]["complete"] = true;
  detection["roles"][0]["found"] = 6;
  EXPECT_EQ(of_document(detection).verdict, Verdict::pass);
  detection["roles"][0]["false_alarms"] = {"seed 3: late"};
  EXPECT_EQ(of_document(detection).verdict, Verdict::fail);
  detection["roles"] = OrderedJson::array();
  EXPECT_EQ(of_document(detection).verdict, Verdict::inconclusive);
}

TEST(JoinedVerdict, ATerminalGetsNoControlCharacters) {
  PageContent content;
  content.runs = {run_of("a\x1b[2J", {Verdict::pass}), run_of("b", {Verdict::fail})};
  const std::string text = joined_text(joined_verdict(content));
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_EQ(text.substr(0, text.find('\n')), "fail: 2 runs: 1 failed (1 of 2 judged cases failed)");
}

// The order of the runs changes no verdict, and a run more never makes it better.
RC_GTEST_PROP(JoinedVerdict, IsTheWorstOfItsRunsInAnyOrder, ()) {
  const auto verdict = rc::gen::map(rc::gen::inRange(0, 7), [](int n) { return static_cast<Verdict>(n); });
  PageContent content;
  for (const auto& verdicts : *rc::gen::container<std::vector<std::vector<Verdict>>>(
           rc::gen::container<std::vector<Verdict>>(verdict))) {
    content.runs.push_back(run_of("run", verdicts));
  }
  const Verdict whole = joined_verdict(content).verdict;
  std::ranges::reverse(content.runs);
  RC_ASSERT(joined_verdict(content).verdict == whole);
  if (content.runs.empty()) return;
  for (const PageRun& run : content.runs) RC_ASSERT(headline(run.stored.run) <= whole);
  content.runs.pop_back();
  RC_ASSERT(joined_verdict(content).verdict <= whole);
}

}  // namespace
}  // namespace fieldproof::reports
