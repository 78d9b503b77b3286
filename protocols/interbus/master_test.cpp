// The master on rings of real slaves.
#include "protocols/interbus/master.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "protocols/interbus/ring.hpp"
#include "protocols/interbus/timing.hpp"

namespace fieldproof::interbus {
namespace {

StationDescription station(std::string name, std::uint16_t id) {
  StationDescription description;
  description.name = std::move(name);
  description.id_code = id;
  return description;
}

// A coupler with a 16-bit input and a 16-bit output module after its second interface.
NetworkDescription coupler_and_modules() {
  NetworkDescription network;
  network.name = "paper";
  StationDescription coupler = station("coupler", 0x0008);
  coupler.branch = {station("di", 0x01BE), station("do", 0x01BD)};
  for (StationDescription& local : coupler.branch) local.is_local = true;
  network.stations = {coupler};
  network.copy = {{"di", 0, "do", 0}};
  return network;
}

struct Bench {
  explicit Bench(const NetworkDescription& description)
      : network(description), master(master_configuration(network)) {
    const std::size_t seat = segment.attach(master, "master");
    ring = std::make_unique<Ring>(segment, network, seat);
    master.wire(ring->out());
    master.on_cycle_end([this](kernel::Time now, bool data, bool accepted) {
      if (data) ends.push_back(now);
      if (!accepted) ++rejected;
    });
    master.start(segment.now());
    segment.refresh(seat);
  }
  void run_for(kernel::Duration duration) { segment.run_for(duration); }

  NetworkDescription network;
  segment::Segment segment;
  Master master;
  std::unique_ptr<Ring> ring;
  std::vector<kernel::Time> ends;
  int rejected = 0;
};

TEST(Master, brings_up_the_network_of_the_paper_with_its_cycle_time) {
  Bench bench(coupler_and_modules());
  bench.run_for(100 * kernel::kMillisecond);
  const MasterStatus status = bench.master.status();
  EXPECT_EQ(status.configuration_error, "");
  ASSERT_EQ(status.state, MasterState::run);
  ASSERT_EQ(status.stations.size(), 3U);
  EXPECT_EQ(status.stations[0], (FoundStation{0x0008, 0, -1, false}));
  EXPECT_EQ(status.stations[1], (FoundStation{0x01BE, 1, 0, true}));
  EXPECT_EQ(status.stations[2], (FoundStation{0x01BD, 1, 1, false}));
  EXPECT_EQ(status.cycle_time, 755 * kernel::kMicrosecond);
  EXPECT_EQ(status.rejected_cycles, 0U);
  ASSERT_GT(bench.ends.size(), 50U);
  for (std::size_t n = 1; n < bench.ends.size(); ++n) {
    EXPECT_EQ(bench.ends[n] - bench.ends[n - 1], status.cycle_time);
  }
}

TEST(Master, needs_the_longer_printed_cycle_with_two_end_telegrams) {
  NetworkDescription network = coupler_and_modules();
  network.rules.end_telegrams = 2;
  Bench bench(network);
  bench.run_for(100 * kernel::kMillisecond);
  EXPECT_EQ(bench.master.status().cycle_time, 814'800 * kernel::kNanosecond);
  EXPECT_EQ(bench.master.status().rejected_cycles, 0U);
}

TEST(Master, copies_inputs_to_outputs) {
  Bench bench(coupler_and_modules());
  bench.run_for(50 * kernel::kMillisecond);
  bench.ring->terminals(2).set_input(0, 0xBEEF);
  bench.run_for(3 * kernel::kMillisecond);
  EXPECT_EQ(bench.master.input(0), 0xBEEF);
  EXPECT_EQ(bench.master.output(1), 0xBEEF);
  EXPECT_EQ(bench.ring->terminals(3).output(0), 0xBEEF);
}

TEST(Master, stops_at_a_cut_cable_and_names_the_place) {
  NetworkDescription network;
  network.name = "line";
  for (int n = 0; n < 4; ++n) network.stations.push_back(station("s" + std::to_string(n), 0x0203));
  Bench bench(network);
  bench.run_for(100 * kernel::kMillisecond);
  ASSERT_EQ(bench.master.status().state, MasterState::run);
  bench.ring->set_cable(3, false);
  bench.run_for(12 * bench.master.status().cycle_time);
  EXPECT_EQ(bench.master.status().state, MasterState::bus_stop);
  bench.run_for(200 * kernel::kMillisecond);
  const MasterStatus status = bench.master.status();
  EXPECT_EQ(status.state, MasterState::bus_stop);
  ASSERT_TRUE(status.has_fault_location);
  EXPECT_EQ(status.fault_location, (FaultLocation{1, 2}));
}

}  // namespace
}  // namespace fieldproof::interbus
