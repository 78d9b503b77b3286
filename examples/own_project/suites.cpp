#include "suites.hpp"

#include "island.hpp"

namespace island {

using namespace fieldproof::conformance;

std::unique_ptr<Suite> valve_bus_suite(ValveBusGiven given) {
  given.own_node = [](const IutRequest& wanted, const NodeConfiguration& configuration) {
    return firmware(configuration, wanted.case_id, wanted.seed);
  };
  return fieldproof::conformance::valve_bus_suite(std::move(given));
}

std::unique_ptr<Suite> product_suite() {
  return island_suite();
}

}  // namespace island
