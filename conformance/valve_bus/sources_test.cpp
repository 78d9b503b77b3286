#include "conformance/valve_bus/sources.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "conformance/valve_bus/host_cases.hpp"
#include "conformance/valve_bus/node_cases.hpp"
#include "conformance/valve_bus/suite.hpp"

namespace fieldproof::conformance {
namespace {

TEST(ValveSources, DetailsOfACaseComeBeforeThoseOfAll) {
  TestCase test_case;
  test_case.reference = valve_sources::paper("frames");
  test_case.details = {{valve_sources::derived("for itself"), {"a"}}};
  rest_also_on(test_case, {{valve_sources::own("for all"), {"a", "b"}}, {valve_sources::own("none"), {"a"}}});
  EXPECT_EQ(test_case.reference_of("a").standing, judge::Standing::derived);
  EXPECT_EQ(test_case.reference_of("b").standing, judge::Standing::own);
  EXPECT_EQ(test_case.reference_of("c").standing, judge::Standing::seed);
  EXPECT_EQ(test_case.details.size(), 2U);
  EXPECT_EQ(test_case.rests_on().standing, judge::Standing::own);
}

// What the paper says nothing of must not be told in its name, whichever case a finding comes from.
TEST(ValveSources, FindingsAboutTimesRestOnOurChoiceInEveryCase) {
  const std::set<std::string> of_times{"answer_too_early", "answer_too_late",     "valves_too_late",
                                       "driver_on_late",   "driver_not_released", "gap_in_answer"};
  const auto suite = valve_bus_suite({});
  std::set<std::string> seen;
  for (const TestCase& test_case : suite->cases()) {
    if (test_case.role() != "node") continue;
    for (const char* mutant :
         {"valves_late", "driver_on_late", "driver_not_released", "gap_between_octets"}) {
      conformance::Setup setup;
      setup.volume = Volume::quick;
      setup.implementations = {{"node", 0, std::string("mutant:") + mutant}};
      const judge::CaseResult result = suite->run(test_case, setup).result;
      for (const judge::Finding& finding : result.findings) {
        if (!of_times.contains(finding.reason)) continue;
        seen.insert(finding.reason);
        EXPECT_EQ(finding.reference.standing, judge::Standing::own) << test_case.id << ' ' << finding.reason;
      }
    }
  }
  EXPECT_EQ(seen.size(), 4U) << "one reason of each mutant";
}

}  // namespace
}  // namespace fieldproof::conformance
