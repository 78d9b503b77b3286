// Subject: what decides is what passed on the line, not what an implementation reports about itself.
#include <gtest/gtest.h>

#include <memory>

#include "emc/immunity.hpp"
#include "emc/profile.hpp"
#include "protocols/valve_bus/host.hpp"
#include "protocols/valve_bus/running_network.hpp"

namespace fieldproof::emc {
namespace {

using valve_bus::Host;
using valve_bus::HostConfiguration;
using valve_bus::HostCounters;
using valve_bus::HostDevice;

// Reports no retries, however many it made.
struct HidesRetries final : Host {
  using Host::Host;
  HostCounters counters(std::uint8_t) const override { return {}; }
};

template <typename Made>
ImmunityResult with_host() {
  valve_bus::RunningStations stations;
  stations.make_host = [](const HostConfiguration& configuration) -> std::unique_ptr<HostDevice> {
    return std::make_unique<Made>(configuration);
  };
  valve_bus::RunningNetwork network(valve_bus::NetworkDescription::even(0, 8, 1000), 1, stations);
  ImmunitySettings settings;
  settings.bursts.level = Level::standard(PortKind::signal, 4);
  settings.duration = 3 * kernel::kSecond;
  return run_immunity(network, LineResponse(Profile::named("A").coupling), settings);
}

TEST(Observed, RetriesAreCountedOnTheLine) {
  const ImmunityResult reference = with_host<Host>();
  ASSERT_TRUE(reference.came_up);
  EXPECT_GT(reference.counts.retried, 0U);
  const ImmunityResult hiding = with_host<HidesRetries>();
  EXPECT_EQ(hiding.counts.retried, reference.counts.retried);
  EXPECT_EQ(hiding.criterion, reference.criterion);
}

}  // namespace
}  // namespace fieldproof::emc
