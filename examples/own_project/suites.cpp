#include "suites.hpp"

#include <conformance/valve_bus/suite.hpp>

#include "island.hpp"

namespace island {

using namespace fieldproof::conformance;

std::unique_ptr<Suite> valve_bus_suite(SuiteGiven given) {
  given.own = own_firmware();
  return fieldproof::conformance::valve_bus_suite(std::move(given));
}

std::unique_ptr<Suite> product_suite(SuiteGiven given) {
  return island_suite(std::move(given));
}

}  // namespace island
