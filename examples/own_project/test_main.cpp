// Every case against the firmware, as a test of GoogleTest.
#include <gtest/gtest.h>
#include <conformance/gtest_catalogue.hpp>

#include "suites.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  using namespace fieldproof::conformance;
  const auto valve_bus = island::valve_bus_suite();
  const auto product = island::product_suite();
  for (const auto* suite : {valve_bus.get(), product.get()}) {
    register_with_googletest(*suite, [](const TestCase&) {
      fieldproof::conformance::Setup setup;
      setup.volume = Volume::quick;
      // What island.pics.json says: options that the island does not have.
      setup.pics.emplace().declare("answers_writes", false);
      setup.pics->declare("loss_limit", fieldproof::kernel::Duration{});
      setup.implementations = {{.role = "node", .uri = "own"}};
      return setup;
    });
  }
  return RUN_ALL_TESTS();
}
