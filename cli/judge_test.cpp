// Subject: cli/judge.cpp
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli/probe/program_fixture.hpp"
#include "harness/kernel/sanitized.hpp"
#include "reports/run_directory.hpp"

// A stored run is judged again without the implementation, in every role and by every kind of attachment.
namespace fieldproof::cli {
namespace {

class JudgeTest : public ProgramFixture {
 protected:
  // Runs a chapter of cases with an implementation, keeps all recordings, and judges them again.
  void expect_same_verdicts(const std::string& selector, const std::string& iut, int exit_code) {
    const Called run = call({"run", selector, "--iut", iut, "--volume", "quick", "--quiet", "--record", "all",
                             "--seed", "3", "--out", "run"});
    EXPECT_EQ(run.exit_code, exit_code) << iut << run.out << run.err;
    const Called again = call({"judge", "run"});
    EXPECT_EQ(again.exit_code, exit_code) << iut << again.out << again.err;
    EXPECT_HOLDS(again.out, ", 0 of them otherwise than before");
    EXPECT_EQ(again.out.find("\n0 of"), std::string::npos) << again.out;
    std::filesystem::remove_all(folder_ / "run");
  }
};

TEST_F(JudgeTest, EveryRoleOfThisProgram) {
  struct Run {
    const char* cases;
    const char* iut;
    int exit_code = 0;
  };
  for (kernel::FewerIfSanitized few(3);
       const Run& one :
       {Run{"interbus/slave/frame_check/**", "slave=ref"},
        Run{"interbus/slave/frame_check/**", "mutant:latches_in_spite_of_own_error", 1},
        Run{"interbus/master/rejection/**", "master=ref"}, Run{"interbus/network/**", "slave@2=ref"},
        Run{"valve_bus/node/write/**", "node=ref"}, Run{"valve_bus/host/retry/**", "host=ref"},
        Run{"fieldbus_dll/isa_dle/data/**", "isa_dle=ref"},
        Run{"fieldbus_dll/isa_las/schedule/**", "isa_las=ref"},
        Run{"fieldbus_dll/ff_device/token/**", "ff_device=ref"},
        Run{"fieldbus_dll/ff_las/schedule/**", "ff_las=ref"}}) {
    if (few.leaves_out()) continue;
    expect_same_verdicts(one.cases, one.iut, one.exit_code);
  }
}

TEST_F(JudgeTest, ImplementationsOutside) {
  const std::string station = "exec:'" FIELDPROOF_EXE "' station ";
  expect_same_verdicts("valve_bus/node/read/**", "plugin:" VALVE_NODE_PLUGIN, 0);
  expect_same_verdicts("valve_bus/node/read/**", "exec:" VALVE_NODE_PROCESS, 0);
  expect_same_verdicts("valve_bus/node/read/**", "exec:" VALVE_NODE_PROCESS " turns_round_late", 1);
  expect_same_verdicts("interbus/slave/data_cycle/**", station + "interbus/slave", 0);
  // One that ends at once.
  expect_same_verdicts("valve_bus/node/read/**", "node=" + station + "valve_bus/node mutant:answers_twice",
                       1);
}

TEST_F(JudgeTest, ACaseMayLastLongerThanAnHour) {
  write("pics.json", R"({"items": {"loss_limit": "3600 s"}})");
  const Called run = call({"run", "valve_bus/node/power/valves_hold_without_a_host", "--pics", "pics.json",
                           "--volume", "quick", "--quiet"});
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
}

TEST_F(JudgeTest, WhatIsMissingIsNoPass) {
  const std::string failed = "valve_bus/node/read/is_answered";
  ASSERT_EQ(call({"run", failed, "valve_bus/node/write/drives_the_valves", "--iut", "mutant:answers_twice",
                  "--record", "all", "--quiet", "--out", "run"})
                .exit_code,
            1);
  std::filesystem::remove_all(folder_ / "run" / "cases" / reports::case_directory_name(failed));
  const Called again = call({"judge", "run"});
  EXPECT_EQ(again.exit_code, 2) << again.out;
  EXPECT_HOLDS(again.err, failed + " failed in the run, and nothing of it is stored");
  call({"run", "valve_bus/node/**", "--volume", "quick", "--record", "all", "--quiet", "--max-time", "1ms",
        "--jobs", "1", "--out", "short"});
  EXPECT_NE(call({"judge", "short"}).exit_code, 0);
}

TEST_F(JudgeTest, OneDamagedRecordingDoesNotEndTheOthers) {
  ASSERT_EQ(call({"run", "valve_bus/node/read/**", "--volume", "quick", "--record", "all", "--out", "run"})
                .exit_code,
            0);
  const auto of_case = folder_ / "run/cases/valve_bus+node+read+is_answered";
  for (const auto& entry : std::filesystem::directory_iterator(of_case)) {
    if (entry.path().filename() != "case.json") std::filesystem::resize_file(entry.path(), 40);
  }
  const Called called = call({"judge", "run"});
  EXPECT_EQ(called.exit_code, 2) << called.out << called.err;
  EXPECT_HOLDS(called.err, "valve_bus/node/read/is_answered is not judged again: ");
  EXPECT_HOLDS(called.out, "pass           valve_bus/node/read/answer_has_no_gaps");
}

TEST_F(JudgeTest, WithoutARecordingItSaysWhy) {
  ASSERT_EQ(call({"run", "valve_bus/node/read/is_answered", "--iut", "mutant:answers_twice", "--record",
                  "none", "--quiet", "--out", "run"})
                .exit_code,
            1);
  EXPECT_HOLDS(call({"judge", "run"}).err,
               "no recording of the implementation is stored; --record failed keeps those of cases that "
               "fail, --record all each");
}

}  // namespace
}  // namespace fieldproof::cli
