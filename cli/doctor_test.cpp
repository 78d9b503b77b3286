// Subject: cli/doctor.cpp
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "cli/probe/program_fixture.hpp"

namespace fieldproof::cli {
namespace {

class DoctorTest : public ProgramFixture {};

TEST_F(DoctorTest, SaysHowWellTheMachineKnowsInstants) {
  const Called called = call({"doctor"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  for (const char* words : {"a look at the clock", "a stamp is known to", "U of a turnaround"})
    EXPECT_HOLDS(called.out, words);
}

TEST_F(DoctorTest, TellsWhatIsAttached) {
  const Called process = call({"doctor", "--iut", "exec:'" FIELDPROOF_EXE "' station valve_bus/node ref"});
  EXPECT_EQ(process.exit_code, 0) << process.err;
  EXPECT_HOLDS(process.out, "attached, calls itself 'fieldproof ref'");
  EXPECT_HOLDS(process.out, "echo, unknown case");
  for (const char* place : {"", "?in-process"}) {
    const Called library = call({"doctor", "--iut", std::string("plugin:" VALVE_NODE_PLUGIN) + place});
    EXPECT_EQ(library.exit_code, 0) << library.err;
    EXPECT_HOLDS(library.out, "calls itself 'valve node in C'");
  }
  EXPECT_HOLDS(call({"doctor", "--iut", "ref"}).out, "nothing is attached");
}

TEST_F(DoctorTest, LooksAtALineAndItsUpperChannel) {
  const Called called = call({"doctor", "--iut",
                              "serial:./line?baud=9600&format=8e1&upper=exec:'" FIELDPROOF_EXE
                              "' station valve_bus/node ref --serial ./line"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  for (const char* words : {"upper channel", "pseudo terminal", "silent for 200 ms"})
    EXPECT_HOLDS(called.out, words);
}

// Two roles can be at a serial line; the upper channel says which one is.
TEST_F(DoctorTest, TakesABoxForWhatItsUpperChannelSays) {
  const Called called = call({"doctor", "--iut",
                              "serial:./line?baud=62500&format=8m1&upper=exec:'" FIELDPROOF_EXE
                              "' station valve_bus/host ref --serial ./line"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_HOLDS(called.out, "upper channel");
}

// It answers hello and echo, and ends when a case begins.
TEST_F(DoctorTest, WhatDoesNotGetThroughACaseIsFive) {
  const std::string node = "examples/valve_node/node.py";
  std::ifstream file(kSourceFolder / node);
  std::string text((std::istreambuf_iterator<char>(file)), {});
  const std::string begin = "            case, settings = case_of(message)\n";
  const std::size_t place = text.find(begin);
  ASSERT_NE(place, std::string::npos);
  text.insert(place + begin.size(), "            if case.startswith('valve_bus/'): sys.exit(3)\n");
  write("node.py", text);
  const Called crashed = call({"doctor", "--iut", "exec:python3 node.py"});
  EXPECT_EQ(crashed.exit_code, 5) << crashed.out << crashed.err;
  EXPECT_HOLDS(crashed.out, "echo, unknown case        as they should be");
  EXPECT_HOLDS(crashed.err, "exit code 3");
  const Called right = call({"doctor", "--iut", "exec:python3 " + (kSourceFolder / node).string()});
  EXPECT_EQ(right.exit_code, 0) << right.err;
  EXPECT_HOLDS(right.out, "role                      valve_bus/node");
  EXPECT_HOLDS(right.out, ": pass");
}

// One that is wrong on the line is attached and can be judged: that is what `run` is for.
TEST_F(DoctorTest, WhatIsOnlyWrongIsUsable) {
  const Called called =
      call({"doctor", "--iut", "exec:'" FIELDPROOF_EXE "' station valve_bus/node mutant:check_is_sum"});
  EXPECT_EQ(called.exit_code, 0) << called.out << called.err;
}

TEST_F(DoctorTest, WhatCannotBeUsedIsFive) {
  for (const char* wrong : {"exec:false", "unix:./nobody", "plugin:./nothing.so", "serial:./nothing"})
    EXPECT_EQ(call({"doctor", "--iut", wrong}).exit_code, 5) << wrong;
  EXPECT_EQ(call({"doctor", "--iut", "serial:"}).exit_code, 64);
}

}  // namespace
}  // namespace fieldproof::cli
