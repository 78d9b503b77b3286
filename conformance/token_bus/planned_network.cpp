#include "conformance/token_bus/planned_network.hpp"

#include <array>

#include "conformance/token_bus/station_mutants.hpp"
#include "protocols/token_bus/attached_station.hpp"
#include "protocols/token_bus/ring_network.hpp"

namespace fieldproof::conformance {
namespace {

class PlannedTokenBus final : public PlannedNetwork {
 public:
  PlannedTokenBus(const NetworkRequest& request, token_bus::RingDescription ring)
      : ring_(std::move(ring)), stations_(request, ring_.stations.size()) {
    static constexpr std::array<std::string_view, 1> kRoles = {"station"};
    expect_roles(request, kRoles);
  }

  std::string name() const override { return ring_.name; }
  // The fast receiver.
  std::string default_profile() const override { return "D"; }
  std::string_view exchange() const override { return "datum of a service"; }

  std::unique_ptr<network::Network> make(std::uint64_t seed) const override {
    token_bus::RingStations stations;
    stations.make = [this, seed](std::size_t position, const token_bus::StationConfiguration& configuration) {
      return stations_.make(position, configuration, seed, token_station_mutants());
    };
    return std::make_unique<token_bus::RingNetwork>(ring_, seed, stations);
  }

 private:
  token_bus::RingDescription ring_;
  Seats<token_bus::StationRole> stations_;
};

}  // namespace

std::unique_ptr<PlannedNetwork> plan_token_bus(const NetworkRequest& request) {
  return std::make_unique<PlannedTokenBus>(request, request.file.empty()
                                                        ? token_bus::RingDescription::built_in()
                                                        : token_bus::RingDescription::load(request.file));
}

}  // namespace fieldproof::conformance
