#include "conformance/valve_bus/planned_network.hpp"

#include <array>

#include "conformance/valve_bus/host_mutants.hpp"
#include "conformance/valve_bus/node_mutants.hpp"
#include "protocols/valve_bus/attached_host.hpp"
#include "protocols/valve_bus/attached_node.hpp"
#include "protocols/valve_bus/running_network.hpp"

namespace fieldproof::conformance {
namespace {

class PlannedValveBus final : public PlannedNetwork {
 public:
  explicit PlannedValveBus(const NetworkRequest& request)
      : network_(network_from(request)), nodes_(request, network_.nodes.size()), hosts_(request, 1) {
    static constexpr std::array<std::string_view, 2> kRoles = {"node", "host"};
    expect_roles(request, kRoles);
  }

  std::string name() const override { return network_.name; }
  std::string default_profile() const override { return "A"; }
  std::string_view exchange() const override { return "poll of a node"; }

  std::unique_ptr<network::Network> make(std::uint64_t seed) const override {
    valve_bus::RunningStations stations;
    stations.make_host = [this, seed](const valve_bus::HostConfiguration& configuration) {
      return hosts_.make(1, configuration, seed, host_mutants());
    };
    stations.make_node = [this, seed](std::size_t position,
                                      const valve_bus::NodeConfiguration& configuration) {
      return nodes_.make(position, configuration, seed, node_mutants());
    };
    return std::make_unique<valve_bus::RunningNetwork>(network_, seed, stations);
  }

 private:
  static valve_bus::NetworkDescription network_from(const NetworkRequest& request) {
    if (!request.file.empty()) return valve_bus::NetworkDescription::load(request.file);
    constexpr unsigned kNodes = 8;
    valve_bus::NetworkDescription network = valve_bus::NetworkDescription::even(0, kNodes, 1000);
    network.copy.push_back({1, 2});
    return network;
  }

  valve_bus::NetworkDescription network_;
  Seats<valve_bus::NodeRole> nodes_;
  Seats<valve_bus::HostRole> hosts_;
};

}  // namespace

std::unique_ptr<PlannedNetwork> plan_valve_bus(const NetworkRequest& request) {
  return std::make_unique<PlannedValveBus>(request);
}

}  // namespace fieldproof::conformance
