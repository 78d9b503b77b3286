// Subject: what `fieldproof fuzz ROLE` says about coverage that it does not see.
#include <gtest/gtest.h>

#include <string>

#include "cli/probe/program_fixture.hpp"

namespace fieldproof::cli {
namespace {

class FuzzRole : public ProgramFixture {
 protected:
  Called fuzz(const std::string& uri) {
    return call({"fuzz", "valve_bus/node", "--iut", uri, "--cases", "3"});
  }
};

TEST_F(FuzzRole, SaysWhatIsMissingWhereNoCoverageIsSeen) {
  const std::string library = "plugin:" VALVE_NODE_PLUGIN;
  EXPECT_HOLDS(fuzz(library).out,
               "in a process of its own, where coverage is not seen; write " + library + "?in-process");
  EXPECT_HOLDS(fuzz(library + "?in-process").out,
               "its library is not compiled with -fsanitize-coverage=trace-pc");
  EXPECT_HOLDS(fuzz("exec:'" FIELDPROOF_EXE "' station valve_bus/node ref").out,
               "of a library in this process alone: plugin:./library.so?in-process");
}

// The page has what the program printed of a finding, and the command on it does the same again.
TEST_F(FuzzRole, APageShowsWhatWasFoundAndHowCoverageGrew) {
  const Called called = call({"fuzz", "valve_bus/node", "--iut", "mutant:check_is_sum", "--cases", "500",
                              "--case", "found.json", "--json", "found_fuzz.json"});
  ASSERT_EQ(called.exit_code, 1) << called.out << called.err;
  const auto document = json("found_fuzz.json");
  const auto& found = document.at("found");
  for (const auto& line : found.at("input")) EXPECT_HOLDS(called.out, line.get<std::string>());
  EXPECT_HOLDS(called.out, found.at("reason").get<std::string>());
  EXPECT_EQ(found.at("reproduce"), "fieldproof replay found.json");
  EXPECT_HOLDS(called.out, "reproduce         fieldproof replay found.json");
  EXPECT_HOLDS(called.out, found.at("found_in").get<std::string>() + " failed");
  EXPECT_EQ(call({"replay", "found.json"}).exit_code, 1);
  const Called clean = call({"fuzz", "valve_bus/node", "--iut", "plugin:" COUNTING_NODE "?in-process",
                             "--cases", "60", "--json", "clean_fuzz.json"});
  ASSERT_EQ(clean.exit_code, 0) << clean.out << clean.err;
  EXPECT_EQ(json("clean_fuzz.json").at("command"),
            "fieldproof fuzz valve_bus/node --iut 'plugin:" COUNTING_NODE "?in-process' --seed 1 --cases 60");
  expect_valid({"found_fuzz.json", "clean_fuzz.json"}, "../../cli/fuzz");
  const Called page = call({"report", "clean_fuzz.json", "found_fuzz.json", "--html", "r.html"});
  EXPECT_EQ(page.exit_code, 0) << page.err;
  EXPECT_EQ(page.out.find("fail: fuzzing valve_bus/node found "), 0U) << page.out;
  EXPECT_HOLDS(page.out,
               "\n  pass          clean_fuzz.json: no finding in 60 sequences of fuzzing valve_bus/node\n");
  EXPECT_HOLDS(read("r.html"), "fieldproof replay found.json");
}

}  // namespace
}  // namespace fieldproof::cli
