#include "protocols/valve_bus/poll_cycle.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/measure/frequency.hpp"
#include "harness/network/network_measurement.hpp"
#include "harness/network/quiet_run.hpp"
#include "protocols/valve_bus/running_network.hpp"
#include "protocols/valve_bus/timing.hpp"

namespace fieldproof::valve_bus {
namespace {

NetworkDescription bus(unsigned nodes, std::vector<CopyRule> copy, bool writes = true) {
  NetworkDescription description = NetworkDescription::even(0, nodes, 1000);
  description.copy = std::move(copy);
  description.writes = writes;
  return description;
}

NetworkDescription with_answered_writes(NetworkDescription description) {
  description.rules.answers_writes = true;
  return description;
}

measure::Measurement measured(const NetworkDescription& description, const char* frequency) {
  network::MeasurementSettings settings;
  settings.signals = {{.frequency = measure::Frequency::read(frequency).value()}};
  settings.duration = 20 * kernel::kSecond;
  return network::measure_network(
      [&](std::uint64_t seed) { return std::make_unique<RunningNetwork>(description, seed); }, settings);
}

struct Bus {
  std::string name;
  NetworkDescription description;
};

// The form walks over steps; the bus is stations on a line.
class PollCycleOf : public testing::TestWithParam<Bus> {};

TEST_P(PollCycleOf, IsWhatTheLineShows) {
  RunningNetwork network(GetParam().description, 7);
  const network::CycleKind kind = network.cycles().front();
  ASSERT_FALSE(kind.is_bound);
  const network::QuietRun run = network::run_quietly(network, 10, 7);
  ASSERT_EQ(run.cycles.size(), 10U);
  EXPECT_EQ(run.counts.detected + run.counts.accepted_wrong() + run.counts.missed_outputs, 0U);
  for (const kernel::Duration cycle : run.cycles) {
    EXPECT_LE(std::chrono::abs(cycle - kind.theory), kernel::kMicrosecond)
        << kernel::describe(cycle) << " instead of " << kernel::describe(kind.theory);
  }
  // By few samples it may be left open.
  EXPECT_NE(measure::agreement(measured(GetParam().description, "7.3Hz")), measure::Agreement::differs);
}

INSTANTIATE_TEST_SUITE_P(
    OfBuses, PollCycleOf,
    testing::Values(Bus{"answered", with_answered_writes(bus(2, {{1, 2}}))},
                    Bus{"to_itself", bus(1, {{1, 1}})}, Bus{"chain", bus(3, {{1, 3}, {2, 1}}, false)},
                    Bus{"backwards", bus(3, {{3, 2}, {2, 1}}, false)},
                    Bus{"two_of_one", bus(4, {{2, 3}, {2, 1}}, false)},
                    Bus{"more_of_one_than_wait_in_the_host",
                        bus(8, {{1, 2}, {1, 3}, {1, 4}, {1, 5}, {1, 6}, {1, 7}, {1, 8}})}),
    [](const auto& one) { return one.param.name; });

// Worked by hand: a poll, 1 ms until the valves have moved, a write.
TEST(PollCycleByHand, OfANodeThatIsCopiedToItself) {
  const Rules rules;
  const PollCycle cycle = poll_cycle(rules, {{0, false}, {0, true, 0}}, {{{}, true}});
  EXPECT_TRUE(cycle.is_steady);
  EXPECT_EQ(cycle.time,
            reference_poll_time(rules).total() + kernel::kMillisecond + reference_write_time(rules));
}

TEST(PollCycleByHand, WhereTheHostRepeatsWritesTheFormsOfPathsAreLeftOpen) {
  NetworkDescription slow = NetworkDescription::even(4, 4, 1000);
  slow.rules.characters = CharacterProfile::eight_bits;
  slow.copy = {{2, 4}};
  const RunningNetwork network(slow, 1);
  EXPECT_TRUE(network.cycles().front().is_bound);
  ASSERT_EQ(network.paths().size(), 1U);
  EXPECT_FALSE(network.paths().front().theory.has_value());
  for (const char* frequency : {"3.1Hz", "7.3Hz"}) {
    const measure::Measurement measurement = measured(slow, frequency);
    EXPECT_EQ(measure::agreement(measurement), measure::Agreement::open) << frequency;
    EXPECT_NE(measurement.conditions.back().value.find("repeats writes"), std::string::npos);
  }
}

}  // namespace
}  // namespace fieldproof::valve_bus
