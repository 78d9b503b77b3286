// Subject: `fieldproof schema` and the numbers that `fieldproof explain` knows, as a user meets them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/probe/program_fixture.hpp"

namespace fieldproof::cli {
namespace {

using SchemaVerb = ProgramFixture;

TEST_F(SchemaVerb, PrintsTheSettingsOfARole) {
  const Called called = call({"schema", "valve_bus/node"});
  ASSERT_EQ(called.exit_code, 0) << called.err;
  const auto schema = nlohmann::json::parse(called.out);
  EXPECT_EQ(schema["properties"]["address_tens"]["maximum"], 15);
}

TEST_F(SchemaVerb, NamesTheNearestOfAWrongName) {
  const Called called = call({"schema", "netwrok"});
  EXPECT_EQ(called.exit_code, 64);
  EXPECT_HOLDS(called.err, "there is no schema 'netwrok'; near to it are ");
  EXPECT_HOLDS(called.err, "interbus/network");
  EXPECT_HOLDS(call({"schema"}).out, "interbus/master\n");
  for (const char* network :
       {"interbus/network", "valve_bus/network", "fieldbus_dll/network", "token_bus/network"}) {
    EXPECT_HOLDS(call({"schema"}).out, std::string(network) + "\n");
    EXPECT_EQ(call({"schema", network}).exit_code, 0) << network;
  }
}

TEST_F(SchemaVerb, ExplainKnowsRolesAndNumbers) {
  EXPECT_HOLDS(call({"explain", "interbus/master"}).out, "cycle_time");
  // Of a scheduler in standby, too.
  for (const char* of : {"derived", "standby/derived"})
    EXPECT_HOLDS(call({"explain", "fieldbus_dll/ff_las"}).out,
                 fmt::format("fieldbus_dll/ff_las/{}/each_unit_spoilt", of));
  const Called called = call({"explain", "loss_limit"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  for (const char* part : {"0 s to 3600.000 s", "own, unverified", "valve_bus/node, "})
    EXPECT_HOLDS(called.out, part);
  const Called wrong = call({"explain", "los_limit"});
  EXPECT_EQ(wrong.exit_code, 64);
  EXPECT_HOLDS(wrong.err, "loss_limit");
}

}  // namespace
}  // namespace fieldproof::cli
