// Registers the cases of a suite with GoogleTest, so that ctest and an IDE show each by its id, and a program
// of a user with GoogleTest's main can judge a station of theirs:
//
//   int main(int argc, char** argv) {
//     testing::InitGoogleTest(&argc, argv);
//     static const auto suite = my_suite();  // of a protocol
//     fieldproof::conformance::register_with_googletest(*suite, [](const auto&) { return my_setup(); });
//     return RUN_ALL_TESTS();
//   }
//
// Contract: the case "PROTOCOL/ROLE/data_cycle/x" is the test "PROTOCOL.ROLE.data_cycle" / "x". The seed of
// the setup is the seed of a run: each case derives its own from it, as `fieldproof run` does. pass and warn
// succeed; not-applicable skips with its reason; everything else fails and prints its findings in full.
// kernel::Error of the setup fails the test with its sentence. Canaries are not registered. The suite must
// outlive the tests. This is a library of its own (fieldproof::gtest): no suite depends on GoogleTest.
#pragma once

#include <functional>
#include <string>

#include "conformance/suite.hpp"
#include "conformance/test_case.hpp"

namespace fieldproof::conformance {

using SetupFactory = std::function<Setup(const TestCase&)>;

// The number of registered cases.
std::size_t register_with_googletest(const Suite& suite, SetupFactory setup_for);

struct GoogleTestName {
  std::string suite;
  std::string test;
};

GoogleTestName googletest_name(const std::string& case_id);

// Every finding of a result as the failure message tells it.
std::string failure_message(const TestCase& test_case, const judge::CaseResult& result);

}  // namespace fieldproof::conformance
