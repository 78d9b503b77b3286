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

}  // namespace
}  // namespace fieldproof::cli
