// Subject: what a start mends makes criterion C, in networks of every protocol; what it does not, D.
#include <gtest/gtest.h>

#include <memory>

#include "emc/immunity.hpp"
#include "emc/profile.hpp"
#include "protocols/fieldbus_dll/ff_network.hpp"
#include "protocols/fieldbus_dll/ff_station.hpp"
#include "protocols/fieldbus_dll/isa_dle.hpp"
#include "protocols/fieldbus_dll/isa_network.hpp"
#include "protocols/valve_bus/node.hpp"
#include "protocols/valve_bus/running_network.hpp"

namespace fieldproof::emc {
namespace {

enum class Hang { until_a_start, for_ever };

// Hears nothing any more from an instant on.
class Hanging {
 public:
  explicit Hanging(Hang hang) : hang_(hang) {}

  bool is_deaf(kernel::Time now) {
    constexpr kernel::Time kFrom = kernel::kStart + 20 * kernel::kSecond;
    is_deaf_ = is_deaf_ || (now >= kFrom && !is_mended_);
    return is_deaf_;
  }
  void start() {
    if (!is_deaf_ || hang_ == Hang::for_ever) return;
    is_mended_ = true;
    is_deaf_ = false;
  }

 private:
  Hang hang_;
  bool is_deaf_ = false;
  bool is_mended_ = false;
};

template <typename Base>
class HangingStation : public Base {
 public:
  template <typename Configuration>
  HangingStation(const Configuration& configuration, Hang hang) : Base(configuration), hanging_(hang) {}

  void receive(segment::PortIndex port, const line::Waveform& reception) override {
    if (!hanging_.is_deaf(reception.start)) Base::receive(port, reception);
  }

 protected:
  Hanging hanging_;
};

struct HangingFf final : HangingStation<fieldbus_dll::FfStation> {
  using HangingStation::HangingStation;
  bool start(kernel::Time now) override {
    hanging_.start();
    return FfStation::start(now);
  }
};

struct HangingIsa final : HangingStation<fieldbus_dll::IsaDle> {
  using HangingStation::HangingStation;
  bool start(kernel::Time now) override {
    hanging_.start();
    return IsaDle::start(now);
  }
};

struct HangingNode final : HangingStation<valve_bus::Node> {
  using HangingStation::HangingStation;
  void set_power(bool is_on, kernel::Time now) override {
    if (is_on) hanging_.start();
    Node::set_power(is_on, now);
  }
};

std::unique_ptr<network::Network> foundation_with(Hang hang) {
  using namespace fieldbus_dll;
  const auto link = LinkDescription::built_in(LinkProfile::foundation);
  FfStations stations;
  stations.make_device = [hang](std::size_t position,
                                const FfConfiguration& configuration) -> std::unique_ptr<FfDevice> {
    return position == 2 ? std::make_unique<HangingFf>(configuration, hang) : nullptr;
  };
  return std::make_unique<FfNetwork>(link, 1, stations);
}

std::unique_ptr<network::Network> isa_with(Hang hang) {
  using namespace fieldbus_dll;
  const auto link = LinkDescription::built_in(LinkProfile::isa);
  IsaStations stations;
  stations.make_device = [hang](std::size_t position,
                                const IsaConfiguration& configuration) -> std::unique_ptr<IsaDevice> {
    return position == 2 ? std::make_unique<HangingIsa>(configuration, hang) : nullptr;
  };
  return std::make_unique<IsaNetwork>(link, 1, stations);
}

std::unique_ptr<network::Network> valve_bus_with(Hang hang) {
  using namespace valve_bus;
  RunningStations stations;
  stations.make_node = [hang](std::size_t position,
                              const NodeConfiguration& configuration) -> std::unique_ptr<NodeDevice> {
    return position == 2 ? std::make_unique<HangingNode>(configuration, hang) : nullptr;
  };
  return std::make_unique<RunningNetwork>(NetworkDescription::even(0, 8, 1000), 1, stations);
}

ImmunityResult judged(network::Network& network) {
  ImmunitySettings settings;
  settings.bursts.level = Level::free(1);  // far below what a receiver notices
  settings.duration = 25 * kernel::kSecond;
  return run_immunity(network, LineResponse(Profile::named("A").coupling), settings);
}

TEST(Restart, WhatAStartMendsIsCriterionC) {
  for (auto* make : {&foundation_with, &isa_with, &valve_bus_with}) {
    const auto network = make(Hang::until_a_start);
    const ImmunityResult result = judged(*network);
    ASSERT_TRUE(result.came_up) << network->name();
    EXPECT_FALSE(result.recovered_by_itself) << network->name();
    EXPECT_TRUE(result.recovered_after_start) << network->name();
    EXPECT_EQ(result.criterion, Criterion::c) << network->name();
    EXPECT_EQ(result.counts.accepted_wrong(), 0U) << network->name();
  }
}

TEST(Restart, WhatAStartDoesNotMendIsCriterionD) {
  for (auto* make : {&foundation_with, &isa_with, &valve_bus_with}) {
    const auto network = make(Hang::for_ever);
    const ImmunityResult result = judged(*network);
    ASSERT_TRUE(result.came_up) << network->name();
    EXPECT_FALSE(result.recovered_after_start) << network->name();
    EXPECT_EQ(result.criterion, Criterion::d) << network->name();
  }
}

}  // namespace
}  // namespace fieldproof::emc
