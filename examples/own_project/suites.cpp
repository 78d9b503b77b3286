#include "suites.hpp"

#include "island.hpp"

namespace island {

using namespace fieldproof::conformance;

std::vector<std::unique_ptr<Suite>> suites(ValveBusGiven given) {
  given.node.own = [](const IutRequest& wanted, const NodeConfiguration& configuration) {
    return firmware(configuration, wanted.case_id, wanted.seed);
  };
  std::vector<std::unique_ptr<Suite>> all;
  all.push_back(valve_bus_suite(std::move(given)));
  all.push_back(island_suite());
  return all;
}

}  // namespace island
