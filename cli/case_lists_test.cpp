// Subject: lists of cases for other programs.
#include "cli/case_lists.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "cli/probe/probe_fixture.hpp"
#include "harness/kernel/arbitrary_text.hpp"

namespace fieldproof::cli {
namespace {

class CaseLists : public Program {
 protected:
  Called ctest(std::vector<std::string> arguments) const {
    Call call = prepared(std::move(arguments), "/bin/sh");
    call.arguments.insert(call.arguments.begin(), {"-c", "exec ctest \"$@\"", "ctest"});
    call.environment["PATH"] = "/usr/local/bin:/usr/bin:/bin";
    return call.run();
  }
};

TEST_F(CaseLists, NeedsHoldEachRequirementOnce) {
  EXPECT_EQ(code({"list", "probe/**", "odd/**", "--needs", "new/needs.json"}), 0);
  const nlohmann::json document = json("new/needs.json");
  const nlohmann::json& version = document["versions"][document["current_version"].get<std::string>()];
  EXPECT_EQ(std::to_string(version["needs"].size()) + "\n",
            probe({"list", "probe/**", "odd/**", "--count"}).out);
  EXPECT_EQ(version["needs_amount"], version["needs"].size());
  std::set<std::string> cases;
  for (const auto& [id, need] : version["needs"].items()) {
    EXPECT_EQ(need["id"], id);
    // What sphinx-needs takes as an id unless it is configured otherwise.
    EXPECT_GE(id.size(), 5U);
    EXPECT_EQ(id.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_"), std::string::npos) << id;
    EXPECT_EQ(need["content"], "what the probe asks for");
    cases.insert(need["case"].get<std::string>());
  }
  EXPECT_EQ(cases.size(), version["needs"].size());
  EXPECT_EQ(version["needs"]["ODD_END_FAILS"]["status"], "unverified");
}

TEST_F(CaseLists, CtestRunsEachCase) {
  ASSERT_EQ(code({"list", "odd/end/fails", "odd/end/warns", "odd/end/is_inconclusive",
                  "odd/end/does_not_apply", "--iut", "ref", "--ctest", "CTestTestfile.cmake"}),
            0);
  const Called ran = ctest({"--test-dir", "."});
  if (ran.exit_code == 127) GTEST_SKIP() << "ctest is not installed; run script/setup";
  EXPECT_EQ(ran.exit_code, 8) << ran.out << ran.err;
  EXPECT_HOLDS(ran.out, "50% tests passed, 2 tests failed out of 4");
  EXPECT_HOLDS(ran.out, "odd/end/fails (Failed)");
  EXPECT_HOLDS(ran.out, "odd/end/is_inconclusive (Failed)");
  EXPECT_HOLDS(ran.out, "odd/end/does_not_apply (Skipped)");
}

TEST_F(CaseLists, CtestIsNeverGreenWithoutTheDevice) {
  const Called none = probe({"list", "probe/**", "--ctest", "CTestTestfile.cmake"});
  EXPECT_EQ(none.exit_code, 64);
  EXPECT_HOLDS(none.err, "--iut exec:./device");
  EXPECT_EQ(code({"list", "probe/**", "--iut", "ref"}), 64);
  EXPECT_EQ(code({"list", "mutants", "--needs", "needs.json"}), 64);
  EXPECT_TRUE(read("CTestTestfile.cmake").empty());
}

TEST(CmakeQuoted, ClosesWhereTheTextEnds) {
  EXPECT_EQ(cmake_quoted("a b"), "[[a b]]");
  EXPECT_EQ(cmake_quoted("a]"), "[=[a]]=]");
  EXPECT_EQ(cmake_quoted("a]]b"), "[=[a]]b]=]");
  EXPECT_EQ(cmake_quoted("a]]b]="), "[==[a]]b]=]==]");
  EXPECT_EQ(cmake_quoted("\na"), "[[\n\na]]");
}

// The bracket that closes comes once, at the end.
RC_GTEST_PROP(CmakeQuoted, HoldsAnyText, ()) {
  const std::string text =
      *kernel::arbitrary_text() + *rc::gen::container<std::string>(rc::gen::element(']', '=', '[', 'x'));
  const std::string quoted = cmake_quoted(text);
  const std::size_t level = quoted.find('[', 1) - 1;
  const std::string close = "]" + std::string(level, '=') + "]";
  RC_ASSERT(quoted.find(close, level + 2) == quoted.size() - close.size());
}

}  // namespace
}  // namespace fieldproof::cli
