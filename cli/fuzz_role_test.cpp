// Subject: `fieldproof fuzz ROLE`, what it says of coverage that it does not see, and of a library that ends
// its process.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli/probe/program_fixture.hpp"
#include "harness/kernel/sanitized.hpp"

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

constexpr const char* kOfTheEnvironment = R"(
#define _GNU_SOURCE
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
/* Ends the process when it is called for the 51st time there. */
static void end_the_51st_time(void) {
  const char* before = getenv("TIMES");
  const int times = before == 0 ? 1 : atoi(before) + 1;
  char text[16];
  if (times > 50) abort();
  snprintf(text, sizeof text, "%d", times);
  setenv("TIMES", text, 1);
}
)";

// A library of the example node that does something to the process when DATA1 is above F0h.
class FuzzOfABrokenLibrary : public ProgramFixture {
 protected:
  Called fuzz_where_it(const std::string& does) {
    const std::string source = std::string(kSourceFolder) + "/examples/valve_node/";
    std::string node = reports::read_text_file(source + "valve_node.c");
    const std::string place = "f[2] ^ f[3]";
    const std::size_t at = node.find(place);
    EXPECT_NE(at, std::string::npos);
    node.replace(at, place.size(), "(f[3] > 0xF0 ? (" + does + ", f[2] ^ f[3]) : f[2] ^ f[3])");
    write("node.c", kOfTheEnvironment + node);
    Call compiler = prepared({"-O1", "-w", "-shared", "-fPIC", "-fsanitize-coverage=trace-pc", "-I",
                              kSourceFolder, source + "plugin.c", "node.c", "-o", "node.so"},
                             installed("cc"));
    const Called compiled = compiler.run();
    EXPECT_EQ(compiled.exit_code, 0) << compiled.err;
    return call({"fuzz", "valve_bus/node", "--iut", "plugin:./node.so?in-process", "--cases", "3000",
                 "--case", "found.json", "--json", "fuzz.json", "--corpus", "kept"});
  }
};

TEST_F(FuzzOfABrokenLibrary, KeepsTheSequenceThatCrashesIt) {
  const Called called = fuzz_where_it("raise(SIGSEGV)");
  ASSERT_EQ(called.exit_code, 1) << called.out << called.err;
  // A sanitizer ends the program in its own way.
  if (!kernel::kIsSanitized) {
    EXPECT_HOLDS(called.out, "the library was ended by signal 11 (Segmentation fault) in sequence ");
  }
  EXPECT_HOLDS(called.out, "fail: implementation_crashed");
  EXPECT_EQ(json("fuzz.json").at("found").at("reason"), "implementation_crashed");
  EXPECT_GT(json("fuzz.json").at("run"), 0);
  EXPECT_FALSE(std::filesystem::is_empty(folder_ / "kept"));
  expect_valid({"fuzz.json"}, "../../cli/fuzz");
  const Called again = call({"replay", "found.json"});
  EXPECT_EQ(again.exit_code, 1) << again.out << again.err;
  EXPECT_HOLDS(again.out, "implementation_crashed");
}

// It is no pass either where it ends by itself, or never comes back in good order.
TEST_F(FuzzOfABrokenLibrary, TakesAnEndOfTheProcessForACrash) {
  const Called called = fuzz_where_it("exit(0)");
  EXPECT_EQ(called.exit_code, 1) << called.out << called.err;
  EXPECT_HOLDS(called.out, "fail: implementation_crashed");
}

// What only happens after others before it cannot be shown alone, and is said so.
TEST_F(FuzzOfABrokenLibrary, SaysWhatOneSequenceAloneDoesNotShow) {
  const Called called = fuzz_where_it("end_the_51st_time()");
  EXPECT_EQ(called.exit_code, 3) << called.out << called.err;
  EXPECT_HOLDS(called.out, "the library ");
  EXPECT_HOLDS(called.out, "not confirmed");
}

}  // namespace
}  // namespace fieldproof::cli
