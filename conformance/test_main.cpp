// The tests of this folder, and every case of the suites by its id: `ctest -R weight_four`, or the test
// explorer of an editor. At quick volume; `fieldproof run` makes the full one.
#include <gtest/gtest.h>

#include "conformance/fieldbus_dll/suite.hpp"
#include "conformance/gtest_catalogue.hpp"
#include "conformance/interbus/suite.hpp"
#include "conformance/token_bus/suite.hpp"
#include "conformance/valve_bus/suite.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  using namespace fieldproof::conformance;
  const auto at_quick_volume = [](const TestCase&) {
    fieldproof::conformance::Setup setup;
    setup.volume = Volume::quick;
    return setup;
  };
  const auto interbus = interbus_suite();
  const auto valve_bus = valve_bus_suite();
  const auto fieldbus_dll = fieldbus_dll_suite();
  const auto token_bus = token_bus_suite();
  register_with_googletest(*interbus, at_quick_volume);
  register_with_googletest(*valve_bus, at_quick_volume);
  register_with_googletest(*fieldbus_dll, at_quick_volume);
  register_with_googletest(*token_bus, at_quick_volume);
  return RUN_ALL_TESTS();
}
