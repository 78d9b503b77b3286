// Subject: `fieldproof plan` as its user meets it.
#include <gtest/gtest.h>

#include <string>

#include "cli/probe/program_fixture.hpp"

namespace fieldproof::cli {
namespace {

class PlanVerb : public ProgramFixture {
 protected:
  Called plan(const std::string& bound, const std::string& per_s = "10") const {
    write("network.json",
          R"({"name": "four nodes", "bit_rate": "1 Mbit/s", "rule": "all_or_urgent", "nodes": [{"count": 4,
          "overhead": "1 ms", "urgent": {"octets": 75, "per_s": 10},
          "time_available": {"octets": 250, "per_s": )" +
              per_s + R"(}}], "urgent_delay": )" + bound + "}");
    return call({"plan", "network.json"});
  }
};

TEST_F(PlanVerb, FindsAndProvesATargetBesideTheModel) {
  const Called called = plan(R"({"at_most": "20 ms"})");
  EXPECT_EQ(called.exit_code, 0) << called.err;
  for (const char* part : {"four nodes: 4 nodes, empty rotation 4 ms", "proven by a longer simulation",
                           "Hong and Son", "rotations"}) {
    EXPECT_HOLDS(called.out, part);
  }
  EXPECT_EQ(called.out.find("warning"), std::string::npos);
  EXPECT_EQ(plan(R"({"at_most": "20 ms"})").out, called.out);
}

TEST_F(PlanVerb, SaysTheBestWhereNothingMeetsTheBound) {
  const Called called = plan(R"({"at_most": "1 ms"})");
  EXPECT_EQ(called.exit_code, 1) << called.err;
  EXPECT_HOLDS(called.out, "no TTRT is proven to meet the bound; the best is");
}

// An urgent packet in a quarter of an hour: no simulation has enough of them, however wide the bound.
TEST_F(PlanVerb, IsInconclusiveWhereItKnowsTooLittle) {
  write("rare.json",
        R"({"name": "rare", "bit_rate": "1 Mbit/s", "rule": "all_or_urgent", "nodes": [{"count": 4,
        "overhead": "1 ms", "urgent": {"octets": 75, "per_s": 0.001}}], "urgent_delay": {"at_most": "1 s"}})");
  const Called called = call({"plan", "rare.json"});
  EXPECT_EQ(called.exit_code, 2) << called.out << called.err;
  EXPECT_HOLDS(called.out, "none is refuted");
}

TEST_F(PlanVerb, NamesTheQueuesThatGrow) {
  const Called called = plan(R"({"at_most": "50 ms", "share": 0.9})", "400");
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_HOLDS(called.out, "warning: the time-available queue of node 2 grows without end: 400.000 packets");
}

TEST_F(PlanVerb, RefusesAWrongFileAndSaysWhere) {
  const Called called = plan(R"({"at_most": 20})");
  EXPECT_EQ(called.exit_code, 65);
  EXPECT_HOLDS(called.err, "/urgent_delay/at_most");
}

TEST_F(PlanVerb, WithoutTimeAvailableDataTheModelStandsBesideIt) {
  write("network.json", R"({"name": "\u001b[31mred", "bit_rate": "1 Mbit/s", "rule": "all_or_urgent",
      "nodes": [{"count": 4, "overhead": "1 ms", "urgent": {"octets": 75, "per_s": 4}}],
      "urgent_delay": {"at_most": "60 ms"}})");
  const Called called = call({"plan", "network.json"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_HOLDS(called.out, "Hong and Son");
  EXPECT_EQ(called.out.find('\x1b'), std::string::npos) << "what a file names steers no terminal";
}

TEST_F(PlanVerb, PlansTheExample) {
  const Called called = call({"plan", (kSourceFolder / "examples/foundation.json").string()});
  EXPECT_EQ(called.exit_code, 0) << called.err;
}

}  // namespace
}  // namespace fieldproof::cli
