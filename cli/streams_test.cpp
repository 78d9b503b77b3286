// Subject: the program as its user meets it. Standard streams that are closed, full or left.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli/probe/probe_fixture.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

using Closed = Program;

TEST_F(Closed, StreamsEndNoRunBeforeItsTime) {
  const Call whole =
      in_shell(call({"run", "odd/slow/case_00", "odd/slow/case_02", "--jobs", "1", "--out", "a"}), "<&- >&-");
  const Called called = whole.run();
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_EQ(called.err.find("max-time"), std::string::npos) << called.err;
  EXPECT_HOLDS(read("a/results.json"), "\"complete\": true");
  EXPECT_HOLDS(read("a/results.json"), "odd/slow/case_02");
}

TEST_F(Closed, OrFullStandardErrorLosesTheLogOnly) {
  EXPECT_EQ(in_shell(call({"run", "probe/**", "--out", "a"}), "2>/dev/full").run().exit_code, 0);
  EXPECT_EQ(in_shell(call({"run", "probe/**", "--out", "b"}), "2>&-").run().exit_code, 0);
  EXPECT_EQ(in_shell(call({"list", "bogus"}), "2>/dev/full").run().exit_code, 64);
  EXPECT_EQ(in_shell(call({"list", "bogus"}), "2>&-").run().exit_code, 64);
}

TEST_F(Closed, OrFullStandardOutputIsNoSuccess) {
  const Called full = in_shell(call({"list"}), ">/dev/full").run();
  EXPECT_EQ(full.exit_code, 74);
  EXPECT_HOLDS(full.err, "the result cannot be written to standard output");
  EXPECT_EQ(in_shell(call({"--version"}), ">/dev/full").run().exit_code, 74);
  // A verdict says more than that.
  EXPECT_EQ(in_shell(call({"run", "odd/end/fails"}), ">/dev/full").run().exit_code, 1);
}

// What is judged is in the directory of the run, and a device that takes nothing stays a device.
TEST_F(Closed, OrFullFileLosesNothingThatIsJudged) {
  fs::create_symlink("/dev/full", folder_ / "full");
  const Called called = probe({"run", "probe/**", "--junit", "full", "--out", "a"});
  EXPECT_EQ(called.exit_code, 74) << called.err;
  EXPECT_HOLDS(called.err, "full: the file cannot be written: No space left on device");
  EXPECT_HOLDS(read("a/results.json"), "\"complete\": true");
  EXPECT_TRUE(fs::is_symlink(folder_ / "full"));
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Closed, ReaderOfTheOutputLetsARunFinishItsDirectory) {
  const Call gone = in_shell(call({"run", "odd/slow/case_0*", "--jobs", "1", "--out", "a"}),
                             "| head -n 1; exec cat /dev/null");
  gone.run();
  EXPECT_HOLDS(read("a/results.json"), "\"complete\": true");
  EXPECT_TRUE(fs::exists(folder_ / "a/junit.xml"));
}

}  // namespace
}  // namespace fieldproof::cli
