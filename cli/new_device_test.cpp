// Subject: `fieldproof new`. What it writes compiles without a warning and gets verdicts, in every role and
// language.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "cli/probe/judged_roles.hpp"
#include "cli/probe/program_fixture.hpp"
#include "cli/protocols.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

class NewDevice : public ProgramFixture {
 protected:
  Called shell(const std::string& command) const {
    Call call = prepared({"-c", command}, "/bin/sh");
    call.environment["PATH"] = "/usr/local/bin:/usr/bin:/bin";
    return call.run();
  }

  // The last line that the verb prints is the command that judges it; here with one case.
  void expect_verdict(const JudgedRole& role, const std::string& iut) const {
    const std::string one = role.path() + "/" + role.test_case;
    const Called run =
        call({"run", one, "--iut", iut, "--volume", "quick", "--quiet", "--out", "run_" + role.path()});
    EXPECT_LE(run.exit_code, 2) << one << run.out << run.err;
    const nlohmann::json result = json("run_" + role.path() + "/results.json")["cases"].at(0);
    EXPECT_TRUE(std::set<std::string>({"pass", "fail", "inconclusive"}).contains(result["verdict"]))
        << one << run.out;
    EXPECT_FALSE(result["reason"].get<std::string>().starts_with("implementation_")) << one << run.out;
  }

  void expect_verdicts(const std::string& language, const std::string& compiler,
                       const std::string& source) const {
    for (const JudgedRole& role : kJudgedRoles) {
      const std::string folder = language + "/" + role.path();
      const Called made = call({"new", role.path(), "--lang", language, "--out", folder});
      ASSERT_EQ(made.exit_code, 0) << made.err;
      EXPECT_HOLDS(made.out, "fieldproof run '" + role.path() + "/**' --iut ");
      const Called built =
          shell(compiler + " -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -shared -fPIC -o " +
                folder + "/libdevice.so " + folder + "/" + source);
      ASSERT_EQ(built.exit_code, 0) << built.err;
      expect_verdict(role, "plugin:./" + folder + "/libdevice.so");
    }
  }
};

TEST(JudgedRoles, AreAllThereAre) {
  use_protocols(built_in_protocols());
  std::set<std::string> listed;
  for (const JudgedRole& role : kJudgedRoles) listed.insert(role.path());
  std::set<std::string> known;
  for (const Role* role : roles()) known.insert(role->path());
  EXPECT_EQ(listed, known);
}

TEST_F(NewDevice, InPythonGetsVerdictsInEachRole) {
  for (const JudgedRole& role : kJudgedRoles) {
    ASSERT_EQ(call({"new", role.path(), "--out", role.path()}).exit_code, 0);
    expect_verdict(role, "exec:python3 " + role.path() + "/device.py");
  }
}

TEST_F(NewDevice, InCGetsVerdictsInEachRole) {
  if (kernel::kIsSanitized) GTEST_SKIP() << "not applicable: a library of another compiler is loaded";
  expect_verdicts("c", "cc -std=c89", "device.c");
}

TEST_F(NewDevice, InCppGetsVerdictsInEachRole) {
  if (kernel::kIsSanitized) GTEST_SKIP() << "not applicable: a library of another compiler is loaded";
  expect_verdicts("cpp", "c++ -std=c++17", "device.cpp");
}

// What it prints is what a user types next.
TEST_F(NewDevice, SaysHowItIsBuiltAndJudged) {
  const Called made = call({"new", "valve_bus/node", "--lang", "c"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  std::vector<std::string> lines;
  std::istringstream text(made.out);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 3U) << made.out;
  EXPECT_EQ(shell(lines[1]).exit_code, 0) << lines[1];
  const std::string command = lines[2].substr(lines[2].find("fieldproof ") + 11);
  const Called run =
      shell("'" FIELDPROOF_EXE "' " + command + " --volume quick --quiet --fail-fast --out judged");
  EXPECT_EQ(run.exit_code, 1) << run.out << run.err;
}

TEST_F(NewDevice, LeavesWhatIsThere) {
  write("mine", "");
  EXPECT_EQ(call({"new", "valve_bus/node", "--out", "a"}).exit_code, 0);
  std::filesystem::remove(folder_ / "a/device.py");
  write("a/device.py", "mine");
  const Called again = call({"new", "valve_bus/node", "--out", "a"});
  EXPECT_EQ(again.exit_code, 64);
  EXPECT_HOLDS(again.err, "a/device.py");
  EXPECT_EQ(read("a/device.py"), "mine");
  EXPECT_EQ(call({"new", "valve_bus/node", "--lang", "rust"}).exit_code, 64);
  EXPECT_EQ(call({"new", "valve_bus/nodes"}).exit_code, 64);
  EXPECT_EQ(call({"new", "valve_bus/node", "--out", "mine/x"}).exit_code, 74);
}

}  // namespace
}  // namespace fieldproof::cli
