// Subject: the program. Every verb works for every role and every attachment, or says in one sentence why it
// cannot.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "cli/probe/judged_roles.hpp"
#include "cli/probe/program_fixture.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::cli {
namespace {

class VerbTable : public ProgramFixture, public testing::WithParamInterface<JudgedRole> {
 protected:
  std::vector<std::pair<std::string, std::string>> attachments() const {
    const std::string role = GetParam().name;
    // One at which a tester on a pseudo terminal is quick enough for a host.
    const std::string baud = role == "host" ? "187500" : "9600";
    return {{"ref", role + "=ref"},
            {"exec:", role + "=exec:'" FIELDPROOF_EXE "' station " + GetParam().path()},
            {"plugin:", role + "=plugin:" VALVE_NODE_PLUGIN},
            {"serial:", role + "=serial:./line?baud=" + baud +
                            "&format=8m1&upper=exec:'" FIELDPROOF_EXE "' station " + GetParam().path() +
                            " --serial ./line"}};
  }

  // What a call says: that it works, or its sentence.
  std::string square(const std::string& verb, const Called& called) const {
    if (called.exit_code <= 4) return "works";
    EXPECT_TRUE(called.exit_code == 5 || called.exit_code == 64 || called.exit_code == 65)
        << verb << " " << called.exit_code << called.out << called.err;
    const std::string sentence = called.err.substr(0, called.err.find('\n'));
    EXPECT_TRUE(sentence.starts_with("fieldproof: ")) << verb << called.err;
    EXPECT_GT(sentence.size(), 40U) << verb << called.err;
    return sentence;
  }

  std::string print(const std::string& verb, const std::string& attachment, const Called& called) const {
    const std::string text = square(verb, called);
    std::cout << fmt::format("{:8} {:24} {:8} {}\n", verb, GetParam().path(), attachment, text);
    return text;
  }

  // What it called, and the folder of the run. On a real line again until this machine was quiet enough to
  // judge.
  std::pair<Called, std::string> run_of(const std::string& one, const std::string& kind,
                                        const std::string& iut) const {
    for (int attempt = 1;; ++attempt) {
      const std::string out = fmt::format("run_{}_{}", kind.substr(0, kind.find(':')), attempt);
      const Called run =
          call({"run", one, "--iut", iut, "--volume", "quick", "--record", "all", "--quiet", "--out", out});
      if (kind != "serial:" || run.exit_code != 2 || attempt == 20) return {run, out};
    }
  }
};

TEST_P(VerbTable, HasNoEmptySquare) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: each part is run under sanitizers by tests of its own";
  const std::string role = GetParam().path();
  const std::string one = fmt::format("{}/{}", role, GetParam().test_case);
  const std::string protocol = GetParam().protocol;
  for (const auto& [kind, iut] : attachments()) {
    const auto [run, out] = run_of(one, kind, iut);
    if (kind == "serial:" && run.exit_code == 2)
      GTEST_SKIP() << "not judged: this machine was never quiet enough for " << one;
    const bool runs = print("run", kind, run) == "works";
    const bool must_run = kind == "ref" || kind == "exec:" || role == "valve_bus/node" ||
                          (kind == "serial:" && role == "valve_bus/host");
    EXPECT_EQ(runs, must_run) << role << kind << run.out << run.err;
    EXPECT_TRUE(!must_run || run.exit_code == 0) << role << kind << run.out << run.err;
    print("verify", kind, call({"verify", one, "--iut", iut, "--volume", "quick", "-n", "2"}));
    print("doctor", kind, call({"doctor", "--iut", iut}));
    print("check", kind, call({"check", role, "--iut", iut, "--cases", "3"}));
    print("fuzz", kind, call({"fuzz", role, "--iut", iut, "--cases", "3"}));
    for (const char* verb : {"emc", "measure"}) {
      std::vector<std::string> words = {verb, protocol, "--iut", iut, "--duration", "1s", "--quiet"};
      const std::vector<std::string> more =
          verb == std::string("emc")
              ? std::vector<std::string>{"--test-levels", "2", "--repetition", "5kHz", "--polarity", "+"}
              : std::vector<std::string>{"--signal", "2Hz"};
      words.insert(words.end(), more.begin(), more.end());
      print(verb, kind, call(words));
    }
    if (!runs) continue;
    std::string folder = one;
    std::ranges::replace(folder, '/', '+');
    const std::string case_file = out + "/cases/" + folder + "/case.json";
    const Called judged = call({"judge", out});
    EXPECT_EQ(judged.exit_code, 0) << role << kind << judged.out << judged.err;
    print("judge", kind, judged);
    print("replay", kind, call({"replay", case_file}));
    print("shrink", kind, call({"shrink", case_file}));
  }
}

using RoleOfTable = std::decay_t<decltype(*std::begin(kJudgedRoles))>;

std::vector<RoleOfTable> roles_of(bool on_real_lines) {
  std::vector<RoleOfTable> roles;
  std::ranges::copy_if(kJudgedRoles, std::back_inserter(roles), [=](const RoleOfTable& one) {
    return (std::string_view(one.protocol) == "valve_bus") == on_real_lines;
  });
  return roles;
}
std::string name_of_role(const testing::TestParamInfo<RoleOfTable>& one) {
  return fmt::format("{}_{}", one.param.protocol, one.param.name);
}

INSTANTIATE_TEST_SUITE_P(All, VerbTable, testing::ValuesIn(roles_of(false)), name_of_role);
// What a real line carries is judged in wall-clock time.
INSTANTIATE_TEST_SUITE_P(SerialRuns, VerbTable, testing::ValuesIn(roles_of(true)), name_of_role);

}  // namespace
}  // namespace fieldproof::cli
