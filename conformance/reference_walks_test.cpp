// Subject: whether the states that walks go through are those of the references.
#include "conformance/reference_walks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/token_bus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::conformance {
namespace {

struct ToldApart {
  const char* role;
  bool is_so;
};

class ReferenceWalksTest : public testing::TestWithParam<ToldApart> {};

// What queues and counts has states that only two commands or more tell apart: there, walks promise nothing
// about machines of as many states. docs/limits.md says so of each role.
TEST_P(ReferenceWalksTest, SingleCommandsTellItsStatesApart) {
  if (kernel::kIsSanitized) GTEST_SKIP() << "not applicable: under sanitizers there are fewer states";
  const std::string path = GetParam().role;
  const std::string protocol = path.substr(0, path.find('/'));
  const auto suite = protocol == "valve_bus"      ? valve_bus_suite()
                     : protocol == "interbus"     ? interbus_suite()
                     : protocol == "fieldbus_dll" ? fieldbus_dll_suite()
                                                  : token_bus_suite();
  for (const SequenceRole& role : suite->sequence_roles()) {
    if (path != protocol + "/" + role.test_case.role()) continue;
    EXPECT_EQ(surprise_of(*suite, role).empty(), GetParam().is_so) << path;
    return;
  }
  ADD_FAILURE() << "no such role";
}

INSTANTIATE_TEST_SUITE_P(
    Roles, ReferenceWalksTest,
    testing::Values(ToldApart{"valve_bus/node", true}, ToldApart{"token_bus/translator", true},
                    ToldApart{"interbus/slave", false}, ToldApart{"fieldbus_dll/ff_device", false},
                    ToldApart{"fieldbus_dll/isa_dle", false}, ToldApart{"token_bus/channel_manager", false}),
    [](const auto& one) {
      std::string name = one.param.role;
      std::ranges::replace(name, '/', '_');
      return name;
    });

}  // namespace
}  // namespace fieldproof::conformance
