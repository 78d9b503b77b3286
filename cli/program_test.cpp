// Subject: the program as its user meets it. Every exit code is shown on fieldproof_probe, whose suites end
// as their names say, and on fieldproof itself where no suite is needed.
#include "cli/program.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cli/probe/program_fixture.hpp"
#include "reports/schema/ajv_judge.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

class Program : public ProgramFixture {
 protected:
  Call call(std::vector<std::string> arguments) const {
    return prepared(std::move(arguments), FIELDPROOF_PROBE);
  }
  Called probe(std::vector<std::string> arguments) const { return call(std::move(arguments)).run(); }
  int code(std::vector<std::string> arguments) const { return probe(std::move(arguments)).exit_code; }

  fs::path case_file(const fs::path& run) const {
    for (const auto& file : fs::recursive_directory_iterator(folder_ / run)) {
      if (file.path().filename() == "case.json") return file.path();
    }
    return {};
  }
};

std::string last_line(const std::string& text) {
  std::stringstream lines(text);
  std::string line;
  std::string last;
  while (std::getline(lines, line)) {
    if (!line.empty()) last = line;
  }
  return last;
}

using ExitCode = Program;

TEST_F(ExitCode, ZeroWhenAllPass) {
  const Called called = probe({"run", "probe/**"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_EQ(called.out.rfind("fieldproof ", 0), 0U) << called.out;
  for (const char* part : {"seed 1,", "suite 0.", "build ", "plan none"}) EXPECT_HOLDS(called.out, part);
  EXPECT_EQ(code({"run", "odd/end/warns"}), 0);
}

TEST_F(ExitCode, OneWhenACaseFailsAndTheLastLineReproducesIt) {
  const Called called = probe({"run", "probe/**", "--iut", "deviant:swapped", "--seed", "77"});
  EXPECT_EQ(called.exit_code, 1) << called.err;
  const std::string command =
      "fieldproof run probe/station/data/word_is_latched --iut deviant:swapped --seed 77";
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
}

TEST_F(ExitCode, FourWhenNothingIsJudged) {
  EXPECT_EQ(code({"run", "odd/end/does_not_apply"}), 4);
  EXPECT_EQ(code({"run", "probe/**", "!probe/**"}), 4);
  EXPECT_EQ(code({"run", "odd/end/*", "--iut", "station=ref"}), 4);
}

TEST_F(ExitCode, FiveWhenTheImplementationIsNotUsable) {
  const Called called = probe({"run", "gone/**", "--iut", "deviant:unreachable"});
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
                                             {"run", "--iut", "deviant:unknown"},
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
  write("plan.json", "{\n  \"rules\": [\n    1,\n    77\n  ]\n}\n");
  const Called plan = probe({"run", "probe/**", "--plan", "plan.json"});
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
  for (const char* option : {"plan", "network", "pics", "out", "json", "junit", "max-time", "iut"}) {
    const Called called = probe({"run", "probe/**", std::string("--") + option, ""});
    EXPECT_EQ(called.exit_code, 64) << option << called.err;
    EXPECT_HOLDS(called.err, std::string("--") + option + ": the value is empty");
  }
  write("lab.json", "{\n\"plan\": \"\"}");
  const Called file = probe({"run", "probe/**", "--config", "lab.json"});
  EXPECT_EQ(file.exit_code, 65);
  EXPECT_HOLDS(file.err, "lab.json:2: /plan: the value is empty");
  write("lab.json", "{\"seed\": 1.5}");
  EXPECT_HOLDS(probe({"run", "--config", "lab.json"}).err, "write a whole number");
}

TEST_F(ExitCode, SixtyFiveForAFileThatNeverEndsOrNeverBegins) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const char* option : {"--plan", "--network", "--pics", "--config"}) {
    for (const char* file : {"/dev/zero", "pipe", "."}) {
      const Called called = probe({"run", "probe/**", option, file});
      EXPECT_EQ(called.exit_code, 65) << option << " " << file << called.err;
    }
  }
}

using Closed = Program;

// The words of a shell around a call of the probe: which streams are open.
Call in_shell(Call call, const std::string& redirections) {
  std::string words = "\"$0\" \"$@\" " + redirections;
  call.arguments.insert(call.arguments.begin(), {"-c", words, call.program});
  call.program = "/bin/sh";
  return call;
}

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

TEST_F(Closed, ReaderOfTheOutputLetsARunFinishItsDirectory) {
  const Call gone = in_shell(call({"run", "odd/slow/case_0*", "--jobs", "1", "--out", "a"}),
                             "| head -n 1; exec cat /dev/null");
  gone.run();
  EXPECT_HOLDS(read("a/results.json"), "\"complete\": true");
  EXPECT_TRUE(fs::exists(folder_ / "a/junit.xml"));
}

// The real program on one case and on a deviation that the case catches.
class OfInterbus : public Program {
 protected:
  Called real(std::vector<std::string> arguments) const {
    Call made = call(std::move(arguments));
    made.program = FIELDPROOF_EXE;
    return made.run();
  }
  // One run of the case; the words follow.
  Called judged(std::vector<std::string> words) const {
    words.insert(words.begin(), {"run", kCase, "--volume", "quick"});
    return real(std::move(words));
  }

  const std::string kCase = "interbus/slave/frame_check/flipped_data_bit_is_rejected_marked_and_told";
  const std::string kDeviant = "deviant:latches_in_spite_of_own_error";
};

TEST_F(OfInterbus, PicsItemThatNobodyKnowsIsRefusedWithTheNearest) {
  write("pics.json", "{\n\"items\": {\"ouputs\": true}\n}");
  const Called misspelled = judged({"--iut", kDeviant, "--pics", "pics.json"});
  EXPECT_EQ(misspelled.exit_code, 65);
  EXPECT_HOLDS(misspelled.err, "pics.json:2: /items/ouputs: ");
  EXPECT_HOLDS(misspelled.err, "\"outputs\"");
  for (const char* answers : {R"({"outputs": "yes"})", R"({"words": true})", R"({"words": -1})",
                              R"({"outputs_while_outgoing_bus_is_reset": "hold"})"}) {
    write("pics.json", std::string("{\"items\": ") + answers + "}");
    EXPECT_EQ(judged({"--pics", "pics.json"}).exit_code, 65) << answers;
    EXPECT_EQ(real({"list", kCase, "--pics", "pics.json"}).exit_code, 65) << answers;
  }
}

TEST_F(OfInterbus, PicsLeavesWhatItDoesNotAnswerAsItIs) {
  write("pics.json", R"({"items": {"reconfiguration_button": true}})");
  EXPECT_EQ(judged({"--iut", kDeviant, "--pics", "pics.json"}).exit_code, 1);
  const Called listed = real({"list", "interbus/slave/**", "--pics", "pics.json"});
  EXPECT_EQ(listed.out.find("not applicable"), std::string::npos) << listed.out;
  write("pics.json", R"({"items": {"outputs": false}})");
  EXPECT_HOLDS(real({"list", "interbus/slave/**", "--pics", "pics.json"}).out, "the slave has no outputs");
}

TEST_F(OfInterbus, PicsItemsAreListed) {
  EXPECT_HOLDS(real({"list", "pics"}).out, "outputs  true or false  the slave has process data outputs\n");
  EXPECT_HOLDS(real({"list", "pics", "--json"}).out, "\"item\": \"outputs_while_outgoing_bus_is_reset\"");
}

TEST_F(OfInterbus, OnePlaceHasOneImplementation) {
  for (const char* other : {"slave=ref", "slave@1=ref", "ref"}) {
    const Called twice = judged({"--iut", "slave=" + kDeviant, "--iut", other});
    EXPECT_EQ(twice.exit_code, 64) << other;
    EXPECT_HOLDS(twice.err, "slave=" + kDeviant);
  }
  // Of two slaves at two places a case for a slave would judge one only; a network has room for both.
  EXPECT_EQ(judged({"--iut", "slave@1=" + kDeviant, "--iut", "slave@2=ref"}).exit_code, 64);
  EXPECT_EQ(real({"run", "interbus/network/timing/cycles_do_not_jitter", "--volume", "quick", "--iut",
                  "slave@1=ref", "--iut", "slave@2=ref"})
                .exit_code,
            0);
}

TEST_F(OfInterbus, PositionIsOneThatANetworkHas) {
  EXPECT_EQ(judged({"--iut", "slave@16=ref"}).exit_code, 0);
  for (const char* far : {"slave@513=ref", "slave@4097=ref", "slave@2147483647=ref"}) {
    const Called called = judged({"--iut", far});
    EXPECT_EQ(called.exit_code, 64) << far << called.err;
    EXPECT_HOLDS(called.err, "at most 512 stations");
  }
}

TEST_F(OfInterbus, WrongFileIsFoundBeforeAnythingIsStored) {
  write("plan.json", "{\n\"rules\": 1}");
  write("network.json", "{\"name\": \"n\", \"bit_rate\": \"500 kbit/s\",\n\"stations\": 1}");
  for (const char* option : {"plan", "network"}) {
    const Called called = judged({std::string("--") + option, std::string(option) + ".json"});
    EXPECT_EQ(called.exit_code, 65);
    EXPECT_HOLDS(called.err, std::string(option) + ".json:2: ");
    EXPECT_FALSE(fs::exists(folder_ / "runs"));
  }
}

TEST_F(OfInterbus, CaseFileIsHeldAgainstWhatThereIs) {
  ASSERT_EQ(judged({"--iut", "slave@2=" + kDeviant, "--out", "a"}).exit_code, 1);
  const fs::path file = fs::relative(case_file("a"), folder_);
  const std::string good = read(file);
  const auto refused = [&](const std::string& part, const std::string& instead) {
    std::string text = good;
    text.replace(text.find(part), part.size(), instead);
    write(file, text);
    const Called called = real({"replay", file.string()});
    EXPECT_EQ(called.exit_code, 65) << instead << called.out;
    EXPECT_HOLDS(called.err, "case.json:");
    return called.err;
  };
  EXPECT_HOLDS(refused(kDeviant, "deviant:latches_in_spite_of_own_eror"), "latches_in_spite_of_own_error");
  EXPECT_HOLDS(refused(kDeviant, "own"), "/implementations/0: ");
  EXPECT_HOLDS(refused("\"role\": \"slave\"", "\"role\": \"slvae\""), "'slvae'");
  EXPECT_HOLDS(refused("\"position\": 2", "\"position\": 513"), "at most 512 stations");
  EXPECT_HOLDS(refused("rejected_marked_and_told", "rejected_marked_and_tol"), "/case: ");
}

TEST_F(OfInterbus, CaseFileIsAsItsSchemaSays) {
  write("pics.json", R"({"items": {"outputs": true}})");
  ASSERT_EQ(judged({"--iut", kDeviant, "--pics", "pics.json", "--out", "a"}).exit_code, 1);
  const fs::path file = case_file("a");
  const auto valid = reports::judge_with_ajv(kSourceFolder, kSourceFolder / "cli/case.schema.json", {file});
  if (!valid.is_available) GTEST_SKIP() << valid.output;
  EXPECT_EQ(valid.exit_code, 0) << valid.output;
  std::string text = read(fs::relative(file, folder_));
  text.replace(text.find("\"volume\": \"quick\""), 17, "\"volume\": \"loud\"");
  write(fs::relative(file, folder_), text);
  EXPECT_EQ(reports::judge_with_ajv(kSourceFolder, kSourceFolder / "cli/case.schema.json", {file}).exit_code,
            1);
  EXPECT_EQ(real({"replay", file.string()}).exit_code, 65);
}

TEST_F(OfInterbus, StoredTextDoesNotSteerTheTerminal) {
  ASSERT_EQ(judged({"--iut", kDeviant, "--out", "a"}).exit_code, 1);
  const fs::path file = fs::relative(case_file("a"), folder_);
  std::string text = read(file);
  const std::size_t at = text.find("\"reason\": \"") + 11;
  write(file, text.insert(at, "\\u001b[2J\\u009b"));
  for (const Called& called : {real({"replay", file.string()}), real({"judge", "a"})}) {
    EXPECT_EQ(called.out.find_first_of("\x1b\x9b"), std::string::npos) << called.out;
  }
  write("lab.json", "{\"volume\": \"\\u001b[2J\", \"seed\": 2}");
  write("keys.json", "{\"s\\u009b\\u202eed\": 2}");
  write("cases.txt", "interbus/\x1b[2J\n");
  for (const Called& called : {real({"run", "--config", "lab.json"}), real({"run", "--config", "keys.json"}),
                               real({"list", "@cases.txt"})}) {
    EXPECT_GE(called.exit_code, 64);
    EXPECT_EQ(called.err.find("\x1b"), std::string::npos) << called.err;
    EXPECT_EQ(called.err.find("\xc2\x9b"), std::string::npos) << called.err;
    EXPECT_EQ(called.err.find("\xe2\x80\xae"), std::string::npos) << called.err;
  }
}

TEST_F(OfInterbus, ReplayNamesThePicsInTheCommandThatReproduces) {
  write("pics.json", R"({"items": {"reconfiguration_button": true}})");
  ASSERT_EQ(judged({"--iut", kDeviant, "--pics", "pics.json", "--out", "a"}).exit_code, 1);
  const Called called = real({"replay", case_file("a").string()});
  EXPECT_HOLDS(called.out, "--pics ");
  EXPECT_HOLDS(called.out, "a/pics.json");
}

TEST_F(OfInterbus, RecordingIsHeldAgainstTheRoleThatItPlays) {
  ASSERT_EQ(judged({"--iut", kDeviant, "--out", "a"}).exit_code, 1);
  const fs::path file = fs::relative(case_file("a"), folder_).parent_path() / "playback.txt";
  const std::string good = read(file);
  const auto judged_with = [&](const std::string& part, const std::string& instead) {
    std::string text = good;
    text.replace(text.find(part), part.size(), instead);
    write(file, text);
    const Called called = real({"judge", "a"});
    EXPECT_EQ(called.exit_code, 65) << instead << called.out << called.err;
    EXPECT_HOLDS(called.err, "playback.txt:");
  };
  EXPECT_EQ(real({"judge", "a"}).exit_code, 1);
  judged_with("\"start\":", "\"start\":-9223372036854775808,\"x\":");
  judged_with("\"when\":", "\"when\":-1,\"x\":");
  judged_with("\"output\":{\"word\":0", "\"output\":{\"word\":2");
  judged_with("\"drive\":", "\"cycle_end\":{\"data_cycle\":true,\"accepted\":true},\"drive\":");
  judged_with("\"devices\":[[",
              "\"devices\":[[{\"at\":0,\"call\":1,\"cycle_end\":{\"data_cycle\":true,"
              "\"accepted\":true}},");
}

TEST_F(OfInterbus, PlanThatMakesTooMuchOfARunIsToldSo) {
  // Each level of each transmission: an arrival of its own, far in the future; a thousand levels more.
  for (const char* effect : {R"({"delay": {"duration": "1000000 s"}})", R"({"repeat": {"count": 1000}})"}) {
    write("plan.json", std::string(R"({"rules": [{"scope": "level", "effect": )") + effect + "}]}");
    const Called called = real({"run", "interbus/network/timing/cycles_do_not_jitter", "--volume", "quick",
                                "--record", "none", "--plan", "plan.json"});
    EXPECT_EQ(called.exit_code, 2) << called.err;
    EXPECT_HOLDS(called.out, "plan_too_heavy");
  }
}

using Interrupted = Program;

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
  write("plan.json", "{\"rules\": [3]}");
  write("pics.json", "{\"items\": {\"x\": true}}");
  EXPECT_EQ(code({"run", "probe/**", "odd/end/fails", "odd/end/warns", "--plan", "plan.json", "--pics",
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

TEST_F(Interrupted, RunHasOneWriter) {
  EXPECT_EQ(code({"run", "odd/slow/**", "--max-time", "100ms", "--jobs", "1", "--out", "short"}) != 0, true);
  const Called both =
      in_shell(call({"run", "--resume", "short", "--jobs", "1"}),
               ">first.txt 2>&1 & first=$!; \"$0\" \"$@\" 2>second.txt; second=$?; wait $first; "
               "echo $? $second >codes.txt")
          .run();
  EXPECT_EQ(both.exit_code, 0);
  const std::string codes = read("codes.txt");
  EXPECT_TRUE(codes == "1 65\n" || codes == "65 1\n") << codes;
  EXPECT_HOLDS(read("first.txt") + read("second.txt"), "another program writes this run");
}

TEST_F(Interrupted, RunIsOnlyResumedAsItWas) {
  EXPECT_EQ(code({"run", "odd/slow/**", "--fail-fast", "--out", "short"}), 1);
  EXPECT_EQ(code({"run", "--resume", "short", "--seed", "2"}), 64);
  EXPECT_EQ(code({"run", "--resume", "short", "probe/**"}), 64);
  EXPECT_EQ(code({"run", "--resume", "short", "--failed"}), 64);
}

using Stored = Program;

TEST_F(Stored, ResultsAreTheSameBytesForAnyNumberOfJobs) {
  const std::vector<std::string> all = {"run", "probe/**", "odd/slow/**", "+odd", "!odd/end/never_repeats"};
  std::vector<std::string> outputs;
  for (const char* jobs : {"1", "2", "4"}) {
    std::vector<std::string> arguments = all;
    arguments.insert(arguments.end(), {"--jobs", jobs, "--out", std::string("jobs") + jobs});
    outputs.push_back(probe(arguments).out);
  }
  EXPECT_EQ(outputs[0], outputs[1]);
  EXPECT_EQ(outputs[0], outputs[2]);
  EXPECT_FALSE(read("jobs1/results.json").empty());
  EXPECT_EQ(read("jobs1/results.json"), read("jobs2/results.json"));
  EXPECT_EQ(read("jobs1/results.json"), read("jobs4/results.json"));
}

TEST_F(Stored, RunsLieBelowRunsWithALinkToTheLatest) {
  EXPECT_EQ(code({"run", "probe/**"}), 0);
  for (const char* file :
       {"manifest.json", "results.json", "junit.xml", "journal.jsonl", "configuration.json"}) {
    EXPECT_TRUE(fs::exists(folder_ / "runs/latest" / file)) << file;
  }
  EXPECT_EQ(code({"run", "probe/**", "--out", "runs/latest"}), 65);
}

TEST_F(Stored, FailingCaseReplaysBitForBit) {
  EXPECT_EQ(code({"run", "probe/station/data/word_is_held", "--iut", "deviant:swapped", "--out", "a"}), 1);
  const fs::path file = case_file("a");
  const Called called = probe({"replay", file.string(), "--bits"});
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_HOLDS(called.out, "equal: verdict, reason and fingerprint are those of the stored run");
  EXPECT_HOLDS(called.out, read(fs::relative(file.parent_path() / "trace.txt", folder_)));
  EXPECT_EQ(code({"replay", file.string(), "--iut", "ref"}), 0);
  EXPECT_EQ(code({"verify", file.string()}), 0);
}

TEST_F(Stored, ReplayTellsWhatDiffers) {
  EXPECT_EQ(code({"run", "probe/station/data/word_is_held", "--iut", "deviant:swapped", "--out", "a"}), 1);
  const fs::path file = fs::relative(case_file("a"), folder_);
  std::string text = read(file);
  text.replace(text.find("wrong_word"), 10, "other_word");
  write(file, text);
  const Called called = probe({"replay", file.string()});
  EXPECT_EQ(called.exit_code, 3);
  EXPECT_HOLDS(called.out, "differs: reason was 'other_word', is 'wrong_word'");
  text.replace(text.find("\"case_seed\": \""), 14, "\"case_seed\": \"1");
  write(file, text);
  const Called bad = probe({"replay", file.string()});
  EXPECT_EQ(bad.exit_code, 65);
  EXPECT_HOLDS(bad.err, "case.json:5: /case_seed: ");
}

TEST_F(Stored, PlanAndPicsTravelWithTheCase) {
  write("plan.json", "{\"rules\": [3]}");
  write("pics.json", "{\"items\": {\"x\": true, \"n\": 4, \"s\": \"zero\"}}");
  EXPECT_EQ(code({"run", "odd/end/fails", "--plan", "plan.json", "--pics", "pics.json", "--out", "a"}), 1);
  fs::remove(folder_ / "plan.json");
  fs::remove(folder_ / "pics.json");
  fs::rename(folder_ / "a", folder_ / "moved");
  EXPECT_EQ(code({"replay", case_file("moved").string()}), 1);
  EXPECT_EQ(read("moved/plan.json"), "{\"rules\": [3]}");
}

TEST_F(Stored, RunIsJudgedAgainFromItsRecordings) {
  EXPECT_EQ(code({"run", "probe/**", "--iut", "deviant:swapped", "--record", "all", "--out", "a"}), 1);
  const Called called = probe({"judge", "a"});
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_HOLDS(called.out, "4 of 4 cases were judged again, 0 of them otherwise than before");
  EXPECT_EQ(code({"run", "probe/**", "--out", "b"}), 0);
  EXPECT_EQ(code({"judge", "b"}), 4);
}

TEST_F(Stored, DifferenceNamesNewFailuresAndFixedOnes) {
  probe({"run", "probe/**", "--iut", "deviant:swapped", "--out", "a"});
  probe({"run", "probe/**", "--iut", "deviant:late", "--out", "b"});
  const Called called = probe({"diff", "a", "b", "--json", "diff.json"});
  EXPECT_EQ(called.exit_code, 1);
  EXPECT_HOLDS(called.out, "new failures (1)");
  EXPECT_HOLDS(called.out, "fixed (3)");
  EXPECT_HOLDS(read("diff.json"), "answer_is_in_time");
  EXPECT_EQ(code({"diff", "a", "a"}), 0);
}

TEST_F(Stored, FailedIsNarrowedBySelectorsAndBySettings) {
  probe({"run", "probe/**", "--iut", "deviant:swapped", "--seed", "9"});
  const Called narrowed = probe({"run", "--failed", "probe/station/data/word_is_h*"});
  EXPECT_EQ(narrowed.exit_code, 1) << narrowed.err;
  EXPECT_HOLDS(narrowed.out, "1 of 1 selected cases judged");
  EXPECT_HOLDS(narrowed.out, "seed 9,");
  EXPECT_EQ(code({"run", "--failed", "--iut", "ref"}), 0);
  EXPECT_EQ(code({"run", "--failed"}), 4);
}

TEST_F(Stored, FailFastEndsAfterTheFirstFailure) {
  const Called called = probe({"run", "probe/**", "--iut", "deviant:swapped", "--fail-fast", "--jobs", "3"});
  EXPECT_EQ(called.exit_code, 1);
  EXPECT_HOLDS(called.out, "1 of 4 selected cases judged: 0 pass, 1 fail; 3 not run");
}

TEST_F(Stored, CopiesThatCannotBeWrittenAreRefusedBeforeTheRun) {
  write("file", "");
  for (const char* option : {"--junit", "--json"}) {
    const Called called = probe({"run", "probe/**", option, "file/x.xml"});
    EXPECT_EQ(called.exit_code, 65);
    EXPECT_FALSE(fs::exists(folder_ / "runs"));
  }
  EXPECT_EQ(code({"matrix", "probe", "--json", "file/x.json"}), 65);
}

TEST_F(Stored, LatestThatIsNoLinkIsToldAndLeavesNothing) {
  fs::create_directories(folder_ / "runs/latest/mine");
  const Called called = probe({"run", "probe/**"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_HOLDS(called.err, "runs/latest does not lead to this run");
  for (const auto& entry : fs::directory_iterator(folder_ / "runs")) {
    EXPECT_NE(entry.path().filename().string().rfind(".latest", 0), 0U) << entry.path();
  }
}

TEST_F(Stored, DocumentsThatAreNoRunAreRefusedAtTheirPlace) {
  EXPECT_EQ(code({"run", "probe/**", "--out", "a"}), 0);
  const std::string good = read("a/results.json");
  const auto refused = [&](const std::string& text) {
    write("a/results.json", text);
    const Called called = probe({"diff", "a", "a"});
    EXPECT_EQ(called.exit_code, 65) << called.err;
    EXPECT_HOLDS(called.err, "a/results.json:");
  };
  refused("{\"schema\": \"fieldproof/results/1\", \"cases\": " + std::string(1'000'000, '['));
  std::string text = good;
  refused(text.replace(text.find("\"selected\": 4"), 13, "\"selected\": -1"));
  text = good;
  refused(text.replace(text.find("\"exit_code\": 0"), 14, "\"exit_code\": 1e300"));
}

using Shown = Program;

TEST_F(Shown, ColourAndBarOnATerminalOnly) {
  Call on_terminal = call({"run", "odd/slow/case_0*"});
  on_terminal.on_terminal = true;
  const std::string seen = on_terminal.run().out;
  EXPECT_HOLDS(seen, "\x1b[32m");
  EXPECT_HOLDS(seen, "10 cases");
  on_terminal.environment["NO_COLOR"] = "1";
  const std::string plain = on_terminal.run().out;
  EXPECT_EQ(plain.find("\x1b[3"), std::string::npos) << plain;
  const Called piped = probe({"run", "odd/slow/case_0*"});
  EXPECT_EQ(piped.out.find('\x1b'), std::string::npos);
  EXPECT_EQ(piped.err.find('\r'), std::string::npos);
}

TEST_F(Shown, MatrixWithAndWithoutAHole) {
  const Called good = probe({"matrix", "probe", "--json", "matrix.json", "--jobs", "2"});
  EXPECT_EQ(good.exit_code, 0) << good.out << good.err;
  EXPECT_EQ(last_line(good.out), "no hole");
  EXPECT_HOLDS(read("matrix.json"), "fieldproof/matrix/1");
  const Called holes = probe({"matrix", "odd"});
  EXPECT_EQ(holes.exit_code, 1);
  EXPECT_HOLDS(holes.out, "hole (uncaught-deviation): no case catches the end deviation 'unseen'");
  EXPECT_HOLDS(holes.out, "hole (false-alarm): odd/end/fails on the reference ends with fail ('always')");
  EXPECT_FALSE(fs::exists(folder_ / "runs"));
}

TEST_F(Shown, CasesDeviationsAndProtocols) {
  EXPECT_EQ(probe({"list", "probe/**", "--count"}).out, "4\n");
  EXPECT_HOLDS(probe({"list", "deviations"}).out, "probe/station/late  M2  answers late");
  EXPECT_HOLDS(probe({"list", "protocols"}).out,
               "probe  roles station, 4 cases (1 more must fail), 2 deviations");
  EXPECT_HOLDS(probe({"list", "+canary", "--json"}).out, "\"id\": \"probe/station/canary\"");
  const std::string explained = probe({"explain", "probe/station/data/word_is_held"}).out;
  for (const char* part : {"unverified", "swapped (M1): swaps the octets of a word", "wrong_word",
                           "fieldproof run probe/station/data/word_is_held --iut station=deviant:swapped"}) {
    EXPECT_HOLDS(explained, part);
  }
}

TEST_F(Shown, EverySettingWithItsOrigin) {
  write("lab.json", "{\"seed\": 3, \"jobs\": 2, \"volume\": \"quick\", \"strict\": true} // of the lab\n");
  Call printed = call({"run", "--config", "lab.json", "--seed", "5", "--print-config"});
  printed.environment = {{"FIELDPROOF_JOBS", "4"}, {"FIELDPROOF_IUT", "deviant:late;ref"}};
  const std::string config = printed.run().out;
  const auto expect_setting = [&](const std::string& name, const std::string& value,
                                  const std::string& origin) {
    std::stringstream lines(config);
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind(name + " ", 0) != 0) continue;
      EXPECT_HOLDS(line, " " + value + " ");
      EXPECT_HOLDS(line, origin);
      return;
    }
    ADD_FAILURE() << name << " is not in\n" << config;
  };
  expect_setting("seed", "5", "command line");
  expect_setting("jobs", "4", "environment, FIELDPROOF_JOBS");
  expect_setting("iut", "deviant:late ; ref", "environment, FIELDPROOF_IUT");
  expect_setting("volume", "quick", "file, lab.json:1: /volume");
  expect_setting("strict", "true", "file, lab.json:1: /strict");
  expect_setting("record", "failed", "default");
}

}  // namespace
}  // namespace fieldproof::cli
