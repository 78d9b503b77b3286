#include "harness/iut/process.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "harness/kernel/error.hpp"

namespace fieldproof::iut {
namespace {

using Words = std::vector<std::string>;
using std::chrono::milliseconds;

constexpr milliseconds kLong{20'000};  // only a fault takes so long

Process shell(const std::string& script) {
  return Process({"/bin/sh", "-c", script});
}

// Waits for a line of its standard output.
std::string line_of(Process& process) {
  std::string line;
  for (char c = 0; ::read(process.from_output().number(), &c, 1) == 1 && c != '\n';) line += c;
  return line;
}

// Not there any more, or only as an entry that nobody has fetched.
bool is_gone(pid_t id) {
  for (int n = 0; n < 20'000; ++n) {
    std::ifstream status("/proc/" + std::to_string(id) + "/stat");
    std::string text;
    std::getline(status, text);
    if (text.empty() || text.find(") Z ") != std::string::npos) return true;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return false;
}

std::ptrdiff_t open_descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return std::distance(begin(all), end(all));
}

TEST(ProcessTest, WordsAreSeparatedByBlanksAndKeptTogetherByQuotes) {
  EXPECT_EQ(words_of("./node"), Words({"./node"}));
  EXPECT_EQ(words_of("  ./node \t a  b "), Words({"./node", "a", "b"}));
  EXPECT_EQ(words_of("'my node' --name \"it's me\""), Words({"my node", "--name", "it's me"}));
  EXPECT_EQ(words_of("node --a='b c'd"), Words({"node", "--a=b cd"}));
  EXPECT_EQ(words_of("node '' \"\""), Words({"node", "", ""}));
}

TEST(ProcessTest, CommandWithoutAProgramIsAMistakeOfTheCommandLine) {
  for (const char* wrong : {"", "   ", "''", "'' node", "./node 'a", "./node \"a'"}) {
    try {
      words_of(wrong);
      ADD_FAILURE() << "taken: " << wrong;
    } catch (const kernel::Error& error) {
      EXPECT_EQ(error.kind(), kernel::ErrorKind::usage) << wrong;
    }
  }
}

TEST(ProcessTest, TellsHowItEnded) {
  Process by_itself = shell("exit 3");
  ASSERT_TRUE(by_itself.has_ended(kLong));
  EXPECT_EQ(by_itself.how_it_ended(), "ended with exit code 3");
  Process by_signal = shell("kill -SEGV $$");
  ASSERT_TRUE(by_signal.has_ended(kLong));
  EXPECT_TRUE(by_signal.how_it_ended().starts_with("was ended by signal 11 (")) << by_signal.how_it_ended();
  by_signal.end_group();
  EXPECT_TRUE(by_signal.how_it_ended().starts_with("was ended by signal 11 (")) << by_signal.how_it_ended();
}

TEST(ProcessTest, EndedOneIsTold) {
  Process process = shell("sleep 1000");
  EXPECT_FALSE(process.has_ended(milliseconds(0)));
  process.end_group();
  EXPECT_TRUE(process.has_ended(milliseconds(0)));
  EXPECT_TRUE(process.how_it_ended().starts_with("was ended by signal 9 (")) << process.how_it_ended();
}

// Who sleeps is kept by nobody; who computes is, and has had time.
TEST(ProcessTest, TellsWhatTheMachineGivesToItsGroup) {
  const Process idle = shell("sleep 1000");
  std::this_thread::sleep_for(milliseconds(200));
  EXPECT_FALSE(idle.effort().is_ready);
  const Process busy = shell("while :; do :; done");
  for (int n = 0; n < 20'000 && busy.effort().processor_time < milliseconds(50); ++n)
    std::this_thread::sleep_for(milliseconds(1));
  const Process::Effort effort = busy.effort();
  EXPECT_GE(effort.processor_time, milliseconds(50));
  EXPECT_TRUE(effort.is_ready);
}

TEST(ProcessTest, StreamsAreThoseOfTheProgram) {
  Process process = shell("read a; echo \"out $a\"; echo \"err $a\" >&2");
  ASSERT_EQ(::write(process.to_input().number(), "x\n", 2), 2);
  EXPECT_EQ(line_of(process), "out x");
  ASSERT_TRUE(process.has_ended(kLong));
  std::string log(16, ' ');
  EXPECT_EQ(::read(process.from_errors().number(), log.data(), log.size()), 6);
  EXPECT_TRUE(log.starts_with("err x\n"));
}

TEST(ProcessTest, GroupEndsWithAGrandchildThatWantsToStay) {
  Process process = shell("(trap '' TERM HUP INT; sleep 1000 & echo $!; wait) & wait");
  const pid_t grandchild = std::stoi(line_of(process));
  ASSERT_EQ(::kill(grandchild, 0), 0);
  process.end_group();
  EXPECT_TRUE(is_gone(grandchild));
}

TEST(ProcessTest, GroupOutlivesItsLeaderUntilItIsEnded) {
  Process process = shell("trap '' TERM; sleep 1000 & echo $!");
  const pid_t orphan = std::stoi(line_of(process));
  ASSERT_TRUE(process.has_ended(kLong));
  ASSERT_EQ(::kill(orphan, 0), 0);
  process.end_group();
  EXPECT_TRUE(is_gone(orphan));
}

// Until then the number of the leader could be given to a stranger, who would get the signal.
TEST(ProcessTest, LeaderThatHasEndedKeepsItsNumberUntilTheGroupIsEnded) {
  Process process = shell("echo $$");
  const pid_t leader = std::stoi(line_of(process));
  ASSERT_TRUE(process.has_ended(kLong));
  EXPECT_EQ(::kill(leader, 0), 0);
  process.end_group();
  EXPECT_NE(::kill(leader, 0), 0);
}

TEST(ProcessTest, DescriptorsAreClosedWithIt) {
  const std::ptrdiff_t before = open_descriptors();
  {
    Process process = shell("sleep 1000");
    EXPECT_EQ(open_descriptors(), before + 3);
    Process moved = std::move(process);
    EXPECT_EQ(open_descriptors(), before + 3);
  }
  EXPECT_EQ(open_descriptors(), before);
  EXPECT_THROW(Process({"./there_is_no_such_program"}), kernel::Error);
  EXPECT_EQ(open_descriptors(), before);
}

TEST(ProcessTest, ProgramGetsNoDescriptorOfAnotherOne) {
  const std::string count = "echo $(ls /proc/self/fd | wc -l)";
  Process alone = shell(count);
  const std::string expected = line_of(alone);
  Process other = shell("sleep 1000");
  Process beside = shell(count);
  EXPECT_EQ(line_of(beside), expected);
}

TEST(ProcessTest, WritingToOneThatHasEndedIsAnErrorAndNotTheEndOfTheBench) {
  Process process = shell("exit 0");
  ASSERT_TRUE(process.has_ended(kLong));
  EXPECT_EQ(::write(process.to_input().number(), "x", 1), -1);
  EXPECT_EQ(errno, EPIPE);
}

}  // namespace
}  // namespace fieldproof::iut
