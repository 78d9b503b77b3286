// The tests of this folder, and every case of the suites by its id: `ctest -R weight_four`, or the test
// explorer of an editor. At quick volume; `fieldproof run` makes the full one.
#include <gtest/gtest.h>

#include "conformance/gtest_catalogue.hpp"
#include "conformance/interbus/suite.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  using namespace fieldproof::conformance;
  const auto interbus = interbus_suite();
  register_with_googletest(*interbus, [](const TestCase&) {
    fieldproof::conformance::Setup setup;
    setup.volume = Volume::quick;
    return setup;
  });
  return RUN_ALL_TESTS();
}
