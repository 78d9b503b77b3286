#include "cli/simulated_network.hpp"

#include "protocols/interbus/paper.hpp"

namespace fieldproof::cli {

interbus::NetworkDescription simulated_network_from(const Settings& settings) {
  if (settings.is_set("network")) return interbus::NetworkDescription::load(settings.text("network"));
  interbus::NetworkDescription network = interbus::paper_network();
  network.cycle_time = interbus::kPaperBestCycle;
  return network;
}

}  // namespace fieldproof::cli
