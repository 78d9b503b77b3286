// Subject: the program as its user meets it. The exit codes, each shown on fieldproof_probe, whose suites end
// as their names say, and on fieldproof itself where no suite is needed.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/probe/probe_fixture.hpp"

namespace fieldproof::cli {
namespace {

using ExitCode = Program;

TEST_F(ExitCode, ZeroWhenAllPass) {
  const Called called = probe({"run", "probe/**"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_EQ(called.out.rfind("fieldproof ", 0), 0U) << called.out;
  for (const char* part : {"seed 1,", "suite 0.", "build ", "plan none"}) EXPECT_HOLDS(called.out, part);
  EXPECT_EQ(code({"run", "odd/end/warns"}), 0);
}

TEST_F(ExitCode, OneWhenACaseFailsAndTheLastLineReproducesIt) {
  const Called called = probe({"run", "probe/**", "--iut", "mutant:swapped", "--seed", "77"});
  EXPECT_EQ(called.exit_code, 1) << called.err;
  const std::string command =
      "fieldproof run probe/station/data/word_is_latched --iut mutant:swapped --seed 77";
  EXPECT_EQ(last_line(called.out), "reproduce: " + command);
  EXPECT_EQ(code({"run", "odd/end/warns", "--strict"}), 1);
}

TEST_F(ExitCode, TwoWhenACaseIsInconclusive) {
  EXPECT_EQ(code({"run", "odd/end/is_inconclusive", "probe/**"}), 2);
  EXPECT_EQ(code({"run", "odd/end/is_inconclusive", "--allow-inconclusive"}), 0);
  EXPECT_EQ(code({"run", "odd/end/is_inconclusive", "--strict"}), 1);
}

TEST_F(ExitCode, ThreeWhenAFingerprintDiffers) {
  const Called called = probe({"verify", "odd/end/never_repeats"});
  EXPECT_EQ(called.exit_code, 3);
  EXPECT_HOLDS(called.out, "first difference in line 3 of the recording");
  EXPECT_EQ(code({"verify", "probe/**", "-n", "3"}), 0);
  EXPECT_EQ(code({"verify", "probe/**", "--iut", "mutant:swapped"}), 1);
  EXPECT_EQ(code({"verify", "odd/end/is_inconclusive"}), 2);
}

TEST_F(ExitCode, FourWhenNothingIsJudged) {
  EXPECT_EQ(code({"run", "odd/end/does_not_apply"}), 4);
  EXPECT_EQ(code({"run", "probe/**", "!probe/**"}), 4);
  const Called idle = probe({"run", "odd/end/*", "--iut", "station=ref"});
  EXPECT_EQ(idle.exit_code, 64);
  EXPECT_HOLDS(idle.err, "a station takes part in none of the selected cases, which judge '");
}

TEST_F(ExitCode, FiveWhenTheImplementationIsNotUsable) {
  const Called called = probe({"run", "gone/**", "--iut", "mutant:unreachable"});
  EXPECT_EQ(called.exit_code, 5);
  EXPECT_HOLDS(called.err, "the station does not answer");
  EXPECT_EQ(code({"matrix", "gone"}), 5);
}

TEST_F(ExitCode, SixtyFourForAWrongCommandLine) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"rum"},
                                             {"run", "--sed", "1"},
                                             {"run", "--seed", "x"},
                                             {"run", "--seed", "1", "--seed", "2"},
                                             {"run", "--volume", "loud"},
                                             {"run", "--max-time", "soon"},
                                             {"run", "--jobs", "0"},
                                             {"run", "nothing/**"},
                                             {"run", "--iut", "mutant:unknown"},
                                             {"run", "--iut", "station@0=ref"},
                                             {"run", "--iut", "driver=ref"},
                                             {"run", "--iut", "carrier:pigeon"},
                                             {"explain", "probe/x"},
                                             {"explain"},
                                             {"matrix", "prob"},
                                             {"diff", "a"}}) {
    const Called called = probe(arguments);
    EXPECT_EQ(called.exit_code, 64) << testing::PrintToString(arguments) << called.err;
    EXPECT_EQ(called.err.rfind("fieldproof: ", 0), 0U) << called.err;
    EXPECT_EQ(std::count(called.err.begin(), called.err.end(), '\n'), 1) << called.err;
  }
}

TEST_F(ExitCode, SixtyFourNamesTheNeighboursOfAnUnmatchedSelector) {
  const Called called = probe({"run", "probe/station/data/word_is_heald"});
  EXPECT_EQ(called.exit_code, 64);
  EXPECT_HOLDS(called.err, "the nearest are 'probe/station/data/word_is_held'");
}

TEST_F(ExitCode, SixtyFiveNamesLineAndPointerOfABadFile) {
  write("plan.json", "{\n  \"rules\": [\n    {\"effect\": {\"drop\": {}}},\n    77\n  ]\n}\n");
  const Called plan = probe({"run", "probe/**", "--faults", "plan.json"});
  EXPECT_EQ(plan.exit_code, 65);
  EXPECT_HOLDS(plan.err, "plan.json:4: /rules/1: ");
  write("lab.json", "{\n  \"sed\": 4\n}\n");
  const Called lab = probe({"run", "probe/**", "--config", "lab.json"});
  EXPECT_EQ(lab.exit_code, 65);
  EXPECT_HOLDS(lab.err, "lab.json:2: ");
  EXPECT_HOLDS(lab.err, "\"seed\"");
  write("pics.json", "{\"items\": {\"x\": [1]}}");
  EXPECT_EQ(code({"run", "probe/**", "--pics", "pics.json"}), 65);
  EXPECT_EQ(code({"replay", "nowhere.json"}), 65);
  EXPECT_EQ(code({"judge", "nowhere"}), 65);
}

TEST_F(ExitCode, SeventyForABrokenInvariant) {
  const Called called = probe({"run", "odd/end/breaks", "probe/**"});
  EXPECT_EQ(called.exit_code, 70);
  EXPECT_HOLDS(called.out, "the probe breaks as it promised");
  EXPECT_HOLDS(called.out, "internal_error");
}

TEST_F(ExitCode, OfTheRealProgramForWordsAndFiles) {
  Call real = call({"explain", "no/such/case"});
  real.program = FIELDPROOF_EXE;
  EXPECT_EQ(real.run().exit_code, 64);
  real.arguments = {"replay", "nowhere.json"};
  EXPECT_EQ(real.run().exit_code, 65);
  real.arguments = {"--version"};
  const Called version = real.run();
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out.rfind("fieldproof ", 0), 0U);
}

TEST_F(ExitCode, SixtyFourOrSixtyFiveForAValueThatIsEmpty) {
  for (const char* option : {"faults", "network", "pics", "out", "json", "junit", "max-time", "iut"}) {
    const Called called = probe({"run", "probe/**", std::string("--") + option, ""});
    EXPECT_EQ(called.exit_code, 64) << option << called.err;
    EXPECT_HOLDS(called.err, std::string("--") + option + ": the value is empty");
  }
  write("lab.json", "{\n\"faults\": \"\"}");
  const Called file = probe({"run", "probe/**", "--config", "lab.json"});
  EXPECT_EQ(file.exit_code, 65);
  EXPECT_HOLDS(file.err, "lab.json:2: /faults: the value is empty");
  write("lab.json", "{\"seed\": 1.5}");
  EXPECT_HOLDS(probe({"run", "--config", "lab.json"}).err, "write a whole number");
}

TEST_F(ExitCode, SixtyFiveForAFileThatNeverEndsOrNeverBegins) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const char* option : {"--faults", "--network", "--pics", "--config"}) {
    for (const char* file : {"/dev/zero", "pipe", "."}) {
      const Called called = probe({"run", "probe/**", option, file});
      EXPECT_EQ(called.exit_code, 65) << option << " " << file << called.err;
    }
  }
}

}  // namespace
}  // namespace fieldproof::cli
