// Subject: `fieldproof plan` as its user meets it.
#include <gtest/gtest.h>

#include <string>

#include "cli/probe/program_fixture.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

class PlanVerb : public ProgramFixture {
 protected:
  void expect_valid_against(const std::string& schema) const {
    const auto judgement =
        reports::judge_with_ajv(kSourceFolder, kSourceFolder / schema, {folder_ / "plan.json"});
    if (!judgement.is_available) GTEST_SKIP() << judgement.output;
    EXPECT_EQ(judgement.exit_code, 0) << judgement.output;
  }
  Called plan(const std::string& bound, const std::string& per_s = "10") const {
    write("network.json",
          R"({"name": "four nodes", "bit_rate": "1 Mbit/s", "rule": "all_or_urgent", "nodes": [{"count": 4,
          "overhead": "1 ms", "urgent": {"octets": 75, "per_s": 10},
          "time_available": {"octets": 250, "per_s": )" +
              per_s + R"(}}], "urgent_delay": )" + bound + "}");
    return call({"plan", "network.json"});
  }
};

TEST_F(PlanVerb, FindsAndProvesATargetBesideTheModel) {
  const Called called = plan(R"({"at_most": "20 ms"})");
  EXPECT_EQ(called.exit_code, 0) << called.err;
  for (const char* part : {"four nodes: 4 nodes, empty rotation 4 ms", "proven by a longer simulation",
                           "Hong and Son", "rotations"}) {
    EXPECT_HOLDS(called.out, part);
  }
  EXPECT_EQ(called.out.find("warning"), std::string::npos);
  EXPECT_EQ(plan(R"({"at_most": "20 ms"})").out, called.out);
}

TEST_F(PlanVerb, SaysTheBestWhereNothingMeetsTheBound) {
  const Called called = plan(R"({"at_most": "1 ms"})");
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_HOLDS(called.out, "no TTRT is proven to meet the bound; the best is");
}

// An urgent packet in a quarter of an hour: no simulation has enough of them, however wide the bound.
TEST_F(PlanVerb, IsInconclusiveWhereItKnowsTooLittle) {
  write("rare.json",
        R"({"name": "rare", "bit_rate": "1 Mbit/s", "rule": "all_or_urgent", "nodes": [{"count": 4,
        "overhead": "1 ms", "urgent": {"octets": 75, "per_s": 0.001}}], "urgent_delay": {"at_most": "1 s"}})");
  const Called called = call({"plan", "rare.json"});
  EXPECT_EQ(called.exit_code, 2) << called.out << called.err;
  EXPECT_HOLDS(called.out, "none is refuted");
}

TEST_F(PlanVerb, NamesTheQueuesThatGrow) {
  const Called called = plan(R"({"at_most": "50 ms", "share": 0.9})", "400");
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_HOLDS(called.out, "warning: the time-available queue of node 2 grows without end: 400.000 packets");
}

TEST_F(PlanVerb, RefusesAWrongFileAndSaysWhere) {
  const Called called = plan(R"({"at_most": 20})");
  EXPECT_EQ(called.exit_code, 65);
  EXPECT_HOLDS(called.err, "/urgent_delay/at_most");
}

TEST_F(PlanVerb, WithoutTimeAvailableDataTheModelStandsBesideIt) {
  write("network.json", R"({"name": "\u001b[31mred", "bit_rate": "1 Mbit/s", "rule": "all_or_urgent",
      "nodes": [{"count": 4, "overhead": "1 ms", "urgent": {"octets": 75, "per_s": 4}}],
      "urgent_delay": {"at_most": "60 ms"}})");
  const Called called = call({"plan", "network.json"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_HOLDS(called.out, "Hong and Son");
  EXPECT_EQ(called.out.find('\x1b'), std::string::npos) << "what a file names steers no terminal";
}

TEST_F(PlanVerb, PlansTheExample) {
  const Called called =
      call({"plan", (kSourceFolder / "examples/foundation.json").string(), "--json", "plan.json"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_EQ(json("plan.json")["is_proven"], true);
  expect_valid_against("protocols/fieldbus_dll/target_plan.schema.json");
}

TEST_F(PlanVerb, TheKeyOfAFileSaysWhoPlansIt) {
  write("other.json", R"({"name": "x"})");
  const Called called = call({"plan", "other.json"});
  EXPECT_EQ(called.exit_code, 65);
  EXPECT_HOLDS(
      called.err,
      "no protocol plans this file; one that is planned has \"urgent_delay\" (fieldbus_dll/token_network) or "
      "\"loops\" (bandwidth/network)");
  EXPECT_HOLDS(call({"list", "protocols"}).out, "'fieldproof plan' reads bandwidth/network");
}

class BandwidthPlan : public PlanVerb {
 protected:
  Called plan_loops(const std::string& loops, const std::string& rest = "") const {
    write("network.json",
          R"({"name": "\u001b[31mloops", "nodes": 10, "loops": [)" + loops + "]" + rest + "}");
    return call({"plan", "network.json", "--json", "plan.json"});
  }
};

const std::string kTwoLoops =
    R"({"bound": "60 ms", "sensor": 0, "controller": 1}, {"bound": "180 ms", "sensor": 2, "controller": 3})";

TEST_F(BandwidthPlan, ProvesTheExample) {
  const Called called =
      call({"plan", (kSourceFolder / "examples/bandwidth.json").string(), "--json", "plan.json"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  for (const char* part : {"data of each slot 4 4 4 4 4 4 3 3", "safe up to 2.175 ms; 2.428 ms as the paper",
                           "queues are stable", "just late", "proven by"})
    EXPECT_HOLDS(called.out, part);
  const auto document = json("plan.json");
  EXPECT_EQ(document["is_proven"], true);
  EXPECT_EQ(document["slot_ps"], 20'000'000'000);
  expect_valid_against("protocols/bandwidth/bandwidth_plan.schema.json");
}

TEST_F(BandwidthPlan, ExplainsWhatDoesNotFit) {
  const Called called = plan_loops(kTwoLoops, R"(, "periodic_packet": "9 ms")");
  EXPECT_EQ(called.exit_code, 1) << called.err;
  for (const char* part : {"not feasible: loop 1 makes the slot 20.000 ms", "more\n", "a bound of loop 1 of",
                           "periodic packets of at most", "to leave out"})
    EXPECT_HOLDS(called.out, part);
  EXPECT_EQ(called.out.find('\x1b'), std::string::npos) << "what a file names steers no terminal";
  EXPECT_EQ(json("plan.json")["is_feasible"], false);
  expect_valid_against("protocols/bandwidth/bandwidth_plan.schema.json");
}

// No simulation of this network in its own order meets the one instant at which a datum is 2 us late.
TEST_F(BandwidthPlan, IsNotProvenWhereTheClosedFormIsOverTheSlot) {
  write("late.json", R"({"name": "late", "access": "polling", "rule": "sharp", "nodes": 2,
    "server_overhead": "137 us", "periodic_packet": "200 us", "real_time_packet": "100 us",
    "loops": [{"bound": "39982 us", "sensor": 0, "controller": 1}],
    "real_time": [{"first": 0, "last": 0}, {"first": 1, "last": 1}],
    "non_real_time": [{"first": 1, "last": 1}], "non_real_time_packet": "12455 us"})");
  const Called called = call({"plan", "late.json"});
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_HOLDS(called.out, "non-real-time packets of 12.455 ms are too long; 12.453 ms hold");
}

TEST_F(BandwidthPlan, IsNotProvenWhereRealTimeQueuesGrow) {
  for (kernel::FewerIfSanitized few(2); const char* gap : {"300 us", "1 ps"}) {
    if (few.leaves_out()) continue;
    const Called called = plan_loops(
        kTwoLoops, std::string(R"(, "real_time": [{"first": 8, "last": 8, "mean_gap": ")") + gap + R"("}])");
    EXPECT_EQ(called.exit_code, 1) << gap << called.err;
    EXPECT_HOLDS(called.out, "other queues grow without end");
  }
}

TEST_F(BandwidthPlan, RefusesWhatTakesTooLongToSimulate) {
  const Called called =
      plan_loops(R"({"bound": "1000 s", "sensor": 0, "controller": 1})", R"(, "server_overhead": "1 us")");
  EXPECT_EQ(called.exit_code, 65) << called.out;
  EXPECT_HOLDS(called.err, "too long to simulate");
}

TEST_F(BandwidthPlan, NamesTheDatumThatTooLongPacketsMakeLate) {
  const Called called = plan_loops(
      kTwoLoops, R"(, "non_real_time": [{"first": 0, "last": 9}], "non_real_time_packet": "4 ms")");
  EXPECT_EQ(called.exit_code, 1) << called.err;
  for (const char* part : {"first over T_1", "(node ", "over T_1. Before it go",
                           "not proven: non-real-time packets "
                           "of 4.000 ms are too long"})
    EXPECT_HOLDS(called.out, part);
}

TEST_F(BandwidthPlan, SaysWhatAnUnevenGridCosts) {
  const Called called = plan_loops(R"({"bound": "60 ms", "sensor": 0, "controller": 1, "skew": "4 ms"})",
                                   R"(, "non_real_time": [{"first": 0, "last": 9}])");
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_HOLDS(called.out, "off the grid of the slots");
}

TEST_F(BandwidthPlan, QueuesThatGrowAreNotAPlan) {
  const Called called =
      plan_loops(kTwoLoops, R"(, "non_real_time": [{"first": 0, "last": 9, "mean_gap": "10 ms"}])");
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_HOLDS(called.out, "other queues grow without end");
}

TEST_F(BandwidthPlan, RefusesAWrongFileAndSaysWhere) {
  const Called called = plan_loops(R"({"bound": 60})");
  EXPECT_EQ(called.exit_code, 65);
  EXPECT_HOLDS(called.err, "/loops/0/bound");
}

}  // namespace
}  // namespace fieldproof::cli
