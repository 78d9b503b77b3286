// Subject: the program as its user meets it. Runs that are ended before their time, by a signal or a limit,
// and what can be made of them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/probe/probe_fixture.hpp"
#include "cli/probe/program_fixture.hpp"
#include "harness/judge/journal.hpp"
#include "harness/kernel/campaign.hpp"
#include "harness/kernel/random.hpp"

namespace fieldproof::cli {
namespace {

using Interrupted = Program;
using InterruptedProgram = ProgramFixture;

TEST_F(Interrupted, BySigintWritesThePartialResult) {
  Call interrupted = call({"run", "odd/slow/**", "--out", "stopped", "--jobs", "1"});
  interrupted.signal = SIGINT;
  interrupted.signal_after = "case_02";
  const Called called = interrupted.run();
  EXPECT_EQ(called.exit_code, 130);
  EXPECT_HOLDS(called.out, "the result is incomplete: interrupted by SIGINT");
  EXPECT_HOLDS(read("stopped/results.json"), "interrupted by SIGINT");
  EXPECT_HOLDS(read("stopped/results.json"), "odd/slow/case_02");
}

TEST_F(Interrupted, BySigtermWritesThePartialResult) {
  Call interrupted = call({"run", "odd/slow/**", "--out", "stopped", "--jobs", "2"});
  interrupted.signal = SIGTERM;
  interrupted.signal_after = "case_02";
  EXPECT_EQ(interrupted.run().exit_code, 143);
  EXPECT_HOLDS(read("stopped/results.json"), "interrupted by SIGTERM");
}

// As `timeout` does: to the program, and to its group.
TEST_F(Interrupted, ByTheSameRequestTwiceWritesThePartialResult) {
  Call interrupted = call({"run", "odd/slow/**", "--out", "stopped", "--jobs", "1"});
  interrupted.signal = SIGTERM;
  interrupted.again_after = std::chrono::milliseconds(20);
  interrupted.signal_after = "case_02";
  EXPECT_EQ(interrupted.run().exit_code, 143);
  EXPECT_HOLDS(read("stopped/results.json"), "interrupted by SIGTERM");
}

// Nobody waits for an implementation that hangs: here it gets no call after the first ones, and has answered
// those when it is said to hang.
TEST_F(InterruptedProgram, ByASecondRequestASecondLaterEndsAtOnce) {
  write("node.sh", "(dd bs=1 count=400 status=none; sleep 1; touch hangs; sleep 20) | " +
                       std::string(FIELDPROOF_EXE) + " station valve_bus/node\n");
  Call interrupted = prepared({"run", "valve_bus/node/**", "--out", "stopped", "--jobs", "1", "--iut",
                               "exec:sh node.sh", "--call-limit", "1min"});
  interrupted.signal = SIGTERM;
  interrupted.again_after = std::chrono::milliseconds(1'300);
  interrupted.signal_file = "hangs";
  EXPECT_EQ(interrupted.run().exit_code, 143);
  EXPECT_EQ(read("stopped/results.json").find("interrupted by SIGTERM"), std::string::npos);
}

TEST_F(Interrupted, BySigkillKeepsEveryVerdictThatWasPrinted) {
  Call killed = call({"run", "odd/slow/**", "--out", "killed", "--jobs", "2", "--seed", "5"});
  killed.signal = SIGKILL;
  killed.signal_after = "case_09";
  const Called called = killed.run();
  EXPECT_EQ(called.exit_code, 137);
  const std::string journal = read("killed/journal.jsonl");
  std::stringstream lines(called.out);
  std::size_t printed = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find("odd/slow/");
    if (begin == std::string::npos) continue;
    ++printed;
    EXPECT_HOLDS(journal, "\"" + line.substr(begin, 16) + "\"");
  }
  EXPECT_GE(printed, 10U);
  const Called partial = probe({"diff", "killed", "killed"});
  EXPECT_EQ(partial.exit_code, 2);
  EXPECT_HOLDS(partial.out, "the second run is incomplete: the run did not end; ");

  const Called failed = probe({"run", "--failed", "killed", "--jobs", "2"});
  EXPECT_EQ(failed.exit_code, 1) << failed.err;
  EXPECT_HOLDS(failed.out, "seed 5,");
  EXPECT_HOLDS(failed.out, "fail           odd/slow/case_09");
  EXPECT_EQ(failed.out.find("odd/slow/case_02"), std::string::npos);

  const Called resumed = probe({"run", "--resume", "killed", "--jobs", "2"});
  EXPECT_EQ(resumed.exit_code, 1) << resumed.err;
  EXPECT_HOLDS(resumed.out, "40 of 40 selected cases judged: 30 pass, 10 fail");
  EXPECT_EQ(resumed.out.find("pass           odd/slow/case_00"), std::string::npos);

  // What was interrupted and finished is the same as what was never interrupted.
  EXPECT_EQ(code({"run", "odd/slow/**", "--out", "whole", "--jobs", "2", "--seed", "5", "--quiet"}), 1);
  EXPECT_EQ(read("killed/results.json"), read("whole/results.json"));
}

// At random instants, of which every second comes soon after a verdict was printed, however long a busy
// machine takes for it: what was printed is in the journal, whatever else is there can be read, and the run
// goes on to the same end. FIELDPROOF_KILLS says how many, where 20 are too few.
TEST_F(Interrupted, BySigkillAtAnyInstantLosesNothingThatIsJudged) {
  const auto kills = static_cast<int>(kernel::campaign_count("FIELDPROOF_KILLS", 20));
  const auto into = [&](const std::string& directory) {
    return call({"run", "odd/slow/**", "--jobs", "2", "--seed", "5", "--out", directory});
  };
  ASSERT_EQ(into("whole").run().exit_code, 1);
  kernel::Random random(11);
  for (int n = 0; n < kills; ++n) {
    const std::string directory = "killed" + std::to_string(n);
    const std::string seconds = "0." + std::to_string(1'000 + random.between(0, 999)).substr(1);
    const bool is_after_verdict = n % 2 == 0;
    const std::string last = fmt::format("case_{:02}", random.between(0, 30));
    SCOPED_TRACE(directory + " after " + (is_after_verdict ? last : seconds + " s"));
    Call killed = into(directory);
    if (is_after_verdict) {
      killed.signal = SIGKILL;
      killed.signal_after = last;
    } else {
      killed = in_shell(killed, "& ended=$!; sleep " + seconds + "; kill -KILL $ended; wait $ended");
    }
    const Called called = killed.run();
    const std::string journal = read(directory + "/journal.jsonl");
    std::stringstream lines(called.out);
    bool has_verdict = false;
    for (std::string line; std::getline(lines, line);) {
      const std::size_t begin = line.find("odd/slow/");
      if (begin == std::string::npos || line.size() < begin + 16) continue;
      has_verdict = true;
      EXPECT_HOLDS(journal, "\"" + line.substr(begin, 16) + "\"");
    }
    EXPECT_TRUE(has_verdict || !is_after_verdict);
    if (!std::filesystem::exists(folder_ / directory / "manifest.json")) continue;
    const Called resumed = probe({"run", "--resume", directory, "--jobs", "2"});
    EXPECT_EQ(resumed.exit_code, 1) << resumed.err;
    EXPECT_EQ(read(directory + "/results.json"), read("whole/results.json"));
  }
}

TEST_F(Interrupted, ByMaxTimeIsMarkedIncomplete) {
  const Called called = probe({"run", "odd/slow/**", "--max-time", "600ms", "--jobs", "1", "--out", "short"});
  EXPECT_EQ(called.exit_code, 1);
  EXPECT_HOLDS(called.out, "the result is incomplete: the time of --max-time was over");
  EXPECT_HOLDS(read("short/junit.xml"), "name=\"is_complete\"");
}

// All that was judged passes; what was not judged is no success.
TEST_F(Interrupted, ByMaxTimeIsInconclusive) {
  const std::vector<std::string> short_run = {"run",
                                              "odd/slow/**",
                                              "!odd/slow/case_*1",
                                              "!odd/slow/case_*3",
                                              "!odd/slow/case_*5",
                                              "!odd/slow/case_*7",
                                              "!odd/slow/case_*9",
                                              "--max-time",
                                              "300ms",
                                              "--jobs",
                                              "1",
                                              "--junit",
                                              "junit.xml"};
  EXPECT_EQ(code(short_run), 2);
  EXPECT_HOLDS(read("junit.xml"),
               "<error message=\"the run is incomplete: the time of --max-time was over; ");
  std::vector<std::string> allowed = short_run;
  allowed.emplace_back("--allow-inconclusive");
  EXPECT_EQ(code(allowed), 0);
  EXPECT_HOLDS(read("junit.xml"), "errors=\"0\"");
}

TEST_F(Interrupted, RunIsResumedAsItWasAlsoFromRelativeFiles) {
  write("plan.json", "{\"rules\": [{\"effect\": {\"drop\": {}}}]}");
  write("pics.json", "{\"items\": {\"x\": true}}");
  EXPECT_EQ(code({"run", "probe/**", "odd/end/fails", "odd/end/warns", "--faults", "plan.json", "--pics",
                  "pics.json", "--strict", "--fail-fast", "--out", "short"}),
            1);
  write("pics.json", "{\"items\": {\"x\": false}}");
  const Called changed = probe({"run", "--resume", "short"});
  EXPECT_EQ(changed.exit_code, 64);
  EXPECT_HOLDS(changed.err, "the PICS has changed");
  write("pics.json", "{\"items\": {\"x\": true} }");
  const Called resumed = probe({"run", "--resume", "short"});
  EXPECT_EQ(resumed.exit_code, 1) << resumed.err;
  EXPECT_HOLDS(resumed.out, "6 of 6 selected cases judged");
}

TEST_F(Interrupted, RunKeepsWhatItsVerdictsMeanWhenItIsResumed) {
  EXPECT_EQ(code({"run", "odd/slow/case_00", "odd/end/warns", "--strict", "--max-time", "1ms", "--jobs", "1",
                  "--out", "short"}) != 0,
            true);
  const Called resumed = probe({"run", "--resume", "short"});
  EXPECT_EQ(resumed.exit_code, 1) << resumed.out;
  EXPECT_HOLDS(read("short/junit.xml"), "failures=\"1\"");
}

// Whoever was told to end may need a moment for it: mpirun, for one, does not wait for its ranks.
TEST_F(Interrupted, RunHasOneWriter) {
  EXPECT_EQ(code({"run", "odd/slow/**", "--max-time", "100ms", "--jobs", "1", "--out", "short"}) != 0, true);
  auto writer = std::make_unique<judge::Journal>(folder_ / "short" / "journal.jsonl");
  const Called second = probe({"run", "--resume", "short"});
  EXPECT_EQ(second.exit_code, 65);
  EXPECT_HOLDS(second.err, "another program writes this run");
  const std::jthread ends([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    writer.reset();
  });
  EXPECT_EQ(code({"run", "--resume", "short"}), 1);
}

TEST_F(Interrupted, RunIsOnlyResumedAsItWas) {
  EXPECT_EQ(code({"run", "odd/slow/**", "--fail-fast", "--out", "short"}), 1);
  EXPECT_EQ(code({"run", "--resume", "short", "--seed", "2"}), 64);
  EXPECT_EQ(code({"run", "--resume", "short", "probe/**"}), 64);
  EXPECT_EQ(code({"run", "--resume", "short", "--failed"}), 64);
}

}  // namespace
}  // namespace fieldproof::cli
