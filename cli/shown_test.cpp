// Subject: the program as its user meets it. What is printed about suites, settings and progress.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "cli/probe/probe_fixture.hpp"

namespace fieldproof::cli {
namespace {

namespace fs = std::filesystem;

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
  EXPECT_EQ(last_line(good.out), "no survivor");
  EXPECT_HOLDS(read("matrix.json"), "fieldproof/matrix/1");
  const Called holes = probe({"matrix", "odd"});
  EXPECT_EQ(holes.exit_code, 1);
  EXPECT_HOLDS(holes.out, "surviving-mutant: no case catches the end mutant 'unseen'");
  EXPECT_HOLDS(holes.out, "false-alarm: odd/end/fails on the reference ends with fail ('always')");
  EXPECT_FALSE(fs::exists(folder_ / "runs"));
}

TEST_F(Shown, CasesMutantsAndProtocols) {
  EXPECT_EQ(probe({"list", "probe/**", "--count"}).out, "4\n");
  EXPECT_HOLDS(probe({"list", "mutants"}).out, "probe/station/late  M2  answers late");
  EXPECT_HOLDS(probe({"list", "protocols"}).out,
               "probe  roles station, 4 cases (1 more must fail), 2 mutants");
  EXPECT_HOLDS(probe({"list", "+canary", "--json"}).out, "\"id\": \"probe/station/canary\"");
  const std::string explained = probe({"explain", "probe/station/data/word_is_held"}).out;
  for (const char* part : {"unverified", "swapped (M1): swaps the octets of a word", "wrong_word",
                           "fieldproof run probe/station/data/word_is_held --iut station=mutant:swapped"}) {
    EXPECT_HOLDS(explained, part);
  }
}

TEST_F(Shown, EverySettingWithItsOrigin) {
  write("lab.json", "{\"seed\": 3, \"jobs\": 2, \"volume\": \"quick\", \"strict\": true} // of the lab\n");
  Call printed = call({"run", "--config", "lab.json", "--seed", "5", "--print-config"});
  printed.environment = {{"FIELDPROOF_JOBS", "4"}, {"FIELDPROOF_IUT", "mutant:late;ref"}};
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
  expect_setting("iut", "mutant:late ; ref", "environment, FIELDPROOF_IUT");
  expect_setting("volume", "quick", "file, lab.json:1: /volume");
  expect_setting("strict", "true", "file, lab.json:1: /strict");
  expect_setting("record", "failed", "default");
}

}  // namespace
}  // namespace fieldproof::cli
