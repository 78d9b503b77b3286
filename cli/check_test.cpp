#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/probe/program_fixture.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

class Check : public ProgramFixture {
 protected:
  // The case of a run that failed, in the folder of the test.
  std::string failed_case(const std::string& selector, const std::string& uri) const {
    EXPECT_EQ(call({"run", selector, "--iut", uri, "--volume", "quick", "--out", "run"}).exit_code, kFailed);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "run")) {
      if (entry.path().filename() == "case.json") return entry.path().string();
    }
    ADD_FAILURE() << "no case was stored";
    return {};
  }
};

TEST_F(Check, PassesTheReferenceAndFindsAMutant) {
  const Called passed = call({"check", "valve_bus/node", "--cases", "200"});
  EXPECT_EQ(passed.exit_code, kAllAsExpected);
  EXPECT_HOLDS(passed.out, "200 of 200 sequences");
  const Called found = call({"check", "valve_bus/node", "--iut", "mutant:check_not_reset", "--seed", "1"});
  EXPECT_EQ(found.exit_code, kFailed);
  EXPECT_HOLDS(found.out, "fieldproof replay valve_bus-node-1.case.json");
  EXPECT_HOLDS(found.out, "to 2 commands, 0 faults (0 flipped bits)");
}

TEST_F(Check, CountsCommandsUntilEachMutantIsFound) {
  const Called found = call({"matrix", "valve_bus/node", "--sequences", "--seeds", "1", "--commands", "40",
                             "--json", "found.json"});
  EXPECT_EQ(found.exit_code, 1) << found.out << found.err;  // so few find too little
  EXPECT_HOLDS(found.out, "not found: ");
  EXPECT_HOLDS(found.out, "valve_bus/node: found ");
  EXPECT_HOLDS(read("found.json"), "fieldproof/detection/1");
  const Called no_role = call({"matrix", "valve_bus/valve", "--sequences"});
  EXPECT_EQ(no_role.exit_code, 64);
  EXPECT_HOLDS(no_role.err, "there are no sequences for 'valve_bus/valve'");
  const Called of_cases = call({"matrix", "valve_bus/node"});
  EXPECT_EQ(of_cases.exit_code, 64);
  EXPECT_HOLDS(of_cases.err, "write matrix valve_bus, or matrix valve_bus/node --sequences");
  EXPECT_HOLDS(call({"matrix", "valve_bus", "--seeds", "2"}).err, "--seeds is one of --sequences; add that");
}

TEST_F(Check, ItsCaseIsReplayedAnywhere) {
  call({"check", "valve_bus/node", "--iut", "mutant:read_answers_write", "--case", "found.json"});
  const Called same = call({"replay", "found.json"});
  EXPECT_EQ(same.exit_code, kFailed);
  EXPECT_HOLDS(same.out, "equal: verdict, reason and fingerprint are those of the stored run");
  EXPECT_HOLDS(same.out, "1. write");
  const Called reference = call({"replay", "found.json", "--iut", "ref"});
  EXPECT_EQ(reference.exit_code, kAllAsExpected);
  EXPECT_HOLDS(reference.out, "not compared");
  EXPECT_HOLDS(call({"replay", "found.json", "--bits"}).out, "node/in");
  const Called attached = call({"replay", "found.json", "--iut", std::string("exec:") + VALVE_NODE_PROCESS});
  EXPECT_EQ(attached.exit_code, kAllAsExpected) << attached.out << attached.err;
}

TEST_F(Check, SearchesAnAttachedNodeAndAnInterbusSlave) {
  const Called attached =
      call({"check", "valve_bus/node", "--iut", std::string("exec:") + VALVE_NODE_PROCESS, "--cases", "40"});
  EXPECT_EQ(attached.exit_code, kAllAsExpected) << attached.out << attached.err;
  EXPECT_EQ(call({"check", "interbus/slave", "--cases", "100"}).exit_code, kAllAsExpected);
}

TEST_F(Check, SearchesEachRoleOfTheDataLinkHereAndInAProcess) {
  for (kernel::FewerIfSanitized few(3);
       const std::string role : {"fieldbus_dll/isa_dle", "fieldbus_dll/ff_device", "fieldbus_dll/ff_las"}) {
    if (few.leaves_out()) continue;
    const std::string mutant = role == "fieldbus_dll/ff_las" ? "misses_of_all_count" : "newest_first";
    EXPECT_EQ(call({"check", role, "--iut", "mutant:" + mutant}).exit_code, kFailed) << role;
    const std::string station = "exec:'" FIELDPROOF_EXE "' station " + role + " ";
    const Called passed = call({"check", role, "--iut", station + "ref", "--cases", "60"});
    EXPECT_EQ(passed.exit_code, kAllAsExpected) << role << passed.out << passed.err;
    const Called found = call({"check", role, "--iut", station + "mutant:" + mutant, "--case", "found.json"});
    EXPECT_EQ(found.exit_code, kFailed) << role << found.out << found.err;
  }
}

TEST_F(Check, RefusesWhatItCannotServe) {
  const Called no_role = call({"check", "interbus/network"});
  EXPECT_EQ(no_role.exit_code, kUsage);
  EXPECT_HOLDS(no_role.err, "'valve_bus/node'");
  EXPECT_EQ(call({"check", "valve_bus/node", "--iut", "mutant:nobody"}).exit_code, kUsage);
  EXPECT_EQ(call({"check", "valve_bus/node", "--iut", "exec:./nobody"}).exit_code, 5);
  write("bad.json", R"({"schema": "fieldproof/sequence/1", "role": "valve_bus/node"})");
  const Called bad = call({"replay", "bad.json"});
  EXPECT_EQ(bad.exit_code, 65);
  EXPECT_HOLDS(bad.err, "bad.json");
}

// The reference would be judged in the place of what plays another role.
TEST_F(Check, RefusesWhatPlaysAnotherRole) {
  for (const std::string verb : {"check", "fuzz"}) {
    const Called other = call({verb, "valve_bus/node", "--iut", "host=exec:./nobody", "--cases", "5"});
    EXPECT_EQ(other.exit_code, kUsage) << other.out;
    EXPECT_HOLDS(other.err, "write node=exec:./nobody");
  }
  call({"check", "valve_bus/node", "--iut", "mutant:check_is_sum", "--case", "found.json"});
  EXPECT_EQ(call({"replay", "found.json", "--iut", "host=exec:./nobody"}).exit_code, kUsage);
}

TEST_F(Check, AgreesWithNobodyWhoDroveNothing) {
  // Nothing in this sequence is answered.
  const Called silent = call({"check", "valve_bus/node", "--cases", "1", "--seed", "1"});
  EXPECT_EQ(silent.exit_code, kInconclusive) << silent.out;
  EXPECT_HOLDS(silent.out, "drove nothing in any of them");
}

TEST_F(Check, ShrinksAStoredSequence) {
  write("long.json", R"({"schema": "fieldproof/sequence/1", "role": "valve_bus/node", "seed": "1",
    "implementations": [{"role": "node", "position": 0, "uri": "mutant:read_answers_write"}],
    "commands": [{"do": "wait", "ms": 10}, {"do": "write", "data0": 77, "data1": 3, "silence": 80},
                 {"do": "response", "data0": 1, "data1": 2, "silence": 45},
                 {"do": "read", "data0": 9, "data1": 9, "silence": 45}],
    "verdict": "fail", "reason": "answer_data_wrong", "fingerprint": "0"})");
  const Called shrunk = call({"shrink", "long.json"});
  EXPECT_EQ(shrunk.exit_code, kAllAsExpected) << shrunk.out << shrunk.err;
  EXPECT_EQ(json("long.shrunk.json")["commands"].size(), 2U);
  EXPECT_EQ(call({"replay", "long.shrunk.json"}).exit_code, kFailed);
}

TEST_F(Check, ShrinksBurstsToTheBitsThatMattered) {
  struct Campaign {
    const char* selector;
    const char* uri;
  };
  for (kernel::FewerIfSanitized few(3);
       const Campaign& one :
       {Campaign{"valve_bus/node/immunity/bursts*", "mutant:write_not_checked"},
        Campaign{"valve_bus/node/immunity/bursts*", "mutant:valves_off_on_wrong_check"},
        Campaign{"interbus/slave/immunity/bursts*", "slave=mutant:latches_in_spite_of_own_error"},
        Campaign{"interbus/network/immunity/*", "slave@4=mutant:latches_in_spite_of_own_error"},
        Campaign{"interbus/network/immunity/*", "master=mutant:own_check_ignored"}}) {
    if (few.leaves_out()) continue;
    std::filesystem::remove_all(folder_ / "run");
    const std::string stored = failed_case(one.selector, one.uri);
    const Called shrunk = call({"shrink", stored, "--case", "small.json"});
    EXPECT_EQ(shrunk.exit_code, kAllAsExpected) << one.uri << shrunk.out << shrunk.err;
    std::size_t bits = 0;
    const nlohmann::json plan = json("small.plan.json");
    for (const auto& disturbance : plan["disturbances"]) {
      for (const auto& transmission : disturbance["flipped_bits"]) bits += transmission["bits"].size();
    }
    EXPECT_GE(bits, 1U) << one.uri;
    EXPECT_LE(bits, 2U) << one.uri;
    const Called replayed = call({"replay", "small.json"});
    EXPECT_EQ(replayed.exit_code, kFailed) << replayed.out;
    EXPECT_HOLDS(replayed.out, "equal: verdict, reason and fingerprint are those of the stored run");
    EXPECT_EQ(call({"verify", "small.json"}).exit_code, kFailed);
  }
}

// Its own bursts are out of it: what is left is all that there is to make smaller.
TEST_F(Check, ShrinksASmallBurstCaseAgain) {
  const std::string stored = failed_case("valve_bus/node/immunity/bursts*", "mutant:write_not_checked");
  ASSERT_EQ(call({"shrink", stored, "--case", "small.json"}).exit_code, kAllAsExpected);
  const Called again = call({"shrink", "small.json", "--case", "again.json"});
  EXPECT_EQ(again.exit_code, kAllAsExpected) << again.out << again.err;
  EXPECT_HOLDS(again.out, "shrunk from 1 struck bits to 1");
  EXPECT_EQ(read("again.plan.json"), read("small.plan.json"));
}

TEST_F(Check, LeavesAPlanAloneWhenNothingWasFound) {
  ASSERT_EQ(
      call({"run", "valve_bus/node/immunity/bursts*", "--volume", "quick", "--record", "all", "--out", "run"})
          .exit_code,
      kAllAsExpected);
  write("small.plan.json", "{}");
  const Called shrunk =
      call({"shrink", "run/cases/valve_bus+node+immunity+bursts_move_nothing_by_themselves/case.json",
            "--case", "small.json"});
  EXPECT_EQ(shrunk.exit_code, kDiffers) << shrunk.err;
  EXPECT_HOLDS(shrunk.out, "nothing to shrink");
  EXPECT_EQ(read("small.plan.json"), "{}");
}

}  // namespace
}  // namespace fieldproof::cli
