#include "conformance/interbus/planned_network.hpp"

#include <array>

#include "conformance/interbus/master_mutants.hpp"
#include "conformance/interbus/slave_mutants.hpp"
#include "protocols/interbus/attached_master.hpp"
#include "protocols/interbus/attached_slave.hpp"
#include "protocols/interbus/paper.hpp"
#include "protocols/interbus/running_network.hpp"

namespace fieldproof::conformance {
namespace {

class PlannedInterbus final : public PlannedNetwork {
 public:
  explicit PlannedInterbus(const NetworkRequest& request)
      : network_(planned_interbus_network(request.file)),
        slaves_(request, interbus::ring_order(network_).size()),
        masters_(request, 1),
        latch_(latch_from(request)) {
    static constexpr std::array<std::string_view, 2> kRoles = {"slave", "master"};
    expect_roles(request, kRoles);
  }

  std::string name() const override { return network_.name; }
  std::string default_profile() const override { return "A"; }
  std::string_view exchange() const override { return "cycle"; }

  std::unique_ptr<network::Network> make(std::uint64_t seed) const override {
    interbus::RunningStations stations;
    stations.latch = latch_;
    if (!masters_.is_empty()) {
      stations.make_master = [this, seed](const interbus::MasterConfiguration& configuration) {
        return masters_.make(1, configuration, seed, master_mutants());
      };
    }
    if (!slaves_.is_empty()) {
      stations.make_slave = [this, seed](int position, const interbus::SlaveConfiguration& configuration) {
        return slaves_.make(static_cast<std::size_t>(position), configuration, seed, slave_mutants());
      };
    }
    return std::make_unique<interbus::RunningNetwork>(network_, stations);
  }

 private:
  static interbus::LatchModel latch_from(const NetworkRequest& request) {
    constexpr std::array kModels = {interbus::LatchModel::same_instant, interbus::LatchModel::frame_edges,
                                    interbus::LatchModel::previous_frame};
    return kModels.at(request.latch);
  }

  interbus::NetworkDescription network_;
  Seats<interbus::SlaveRole> slaves_;
  Seats<interbus::MasterRole> masters_;
  interbus::LatchModel latch_;
};

}  // namespace

interbus::NetworkDescription planned_interbus_network(const std::string& file) {
  if (!file.empty()) return interbus::NetworkDescription::load(file);
  interbus::NetworkDescription network = interbus::paper_network();
  network.cycle_time = interbus::kPaperBestCycle;
  return network;
}

std::unique_ptr<PlannedNetwork> plan_interbus(const NetworkRequest& request) {
  return std::make_unique<PlannedInterbus>(request);
}

}  // namespace fieldproof::conformance
