// Subject: a plan of faults that names what a role does not have. It is refused for every role.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "cli/probe/judged_roles.hpp"
#include "cli/probe/program_fixture.hpp"

namespace fieldproof::cli {
namespace {

class FaultPlanNames : public ProgramFixture, public testing::WithParamInterface<JudgedRole> {
 protected:
  Called run_with(const std::string& when) const {
    write("plan.json", fmt::format(R"({{"rules": [{{"when": {}, "effect": {{"drop": {{}}}}}}]}})", when));
    return call({"run", fmt::format("{}/{}", GetParam().path(), GetParam().test_case), "--faults",
                 "plan.json", "--volume", "quick"});
  }
};

TEST_P(FaultPlanNames, AreThoseOfTheRole) {
  if (GetParam().path() == "interbus/master") {
    const Called called = run_with(R"({"receiver": "*"})");
    EXPECT_EQ(called.exit_code, 64);
    EXPECT_HOLDS(called.err, "cases for a master bring their own faults");
    return;
  }
  for (const char* wrong : {R"({"receiver": "nobody/in"})", R"({"receiver": "*", "frame": "nonsense"})",
                            R"({"receiver": "*", "field": "nonsense"})",
                            R"({"receiver": "*", "after": {"observation": "nonsense"}})"}) {
    const Called called = run_with(wrong);
    EXPECT_EQ(called.exit_code, 65) << wrong << called.out << called.err;
    EXPECT_TRUE(called.err.starts_with("fieldproof: /rules/0 of the plan: there is no "))
        << wrong << called.err;
  }
  EXPECT_LT(run_with(R"({"receiver": "*"})").exit_code, 4);
}

INSTANTIATE_TEST_SUITE_P(OfEachRole, FaultPlanNames, testing::ValuesIn(kJudgedRoles));

}  // namespace
}  // namespace fieldproof::cli
