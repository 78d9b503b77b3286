#include "protocols/valve_bus/timing.hpp"

#include <gtest/gtest.h>

#include "harness/kernel/error.hpp"
#include "harness/network/quiet_run.hpp"
#include "protocols/valve_bus/running_network.hpp"

namespace fieldproof::valve_bus {
namespace {

using kernel::kMicrosecond;

// Worked by hand: 146.7 + 200 + 88 + 102.7 us.
TEST(ValveBusTiming, AddsUpAPollByHand) {
  const PollTime time = least_poll_time({}, 200 * kMicrosecond);
  EXPECT_EQ(kernel::describe(time.command), "146.666667 us");
  EXPECT_EQ(kernel::describe(time.response), "88.000 us");
  EXPECT_EQ(kernel::describe(time.silence), "102.666667 us");
  EXPECT_NEAR(static_cast<double>(time.total().count()), 537.333e6, 1e3);
}

TEST(ValveBusTiming, PutsRepeatersBehindTheLoadsThatASegmentBears) {
  const Rules rules;
  EXPECT_EQ(distance_of(rules, 30, 99, 0), kernel::Duration{});
  EXPECT_EQ(distance_of(rules, 31, 99, 0), rules.repeater_delay);
  EXPECT_EQ(distance_of(rules, 60, 99, 0), rules.repeater_delay);
  EXPECT_EQ(distance_of(rules, 61, 99, 0), 2 * rules.repeater_delay);
  EXPECT_EQ(distance_of(rules, 98, 99, 1000), 5 * kMicrosecond + 3 * rules.repeater_delay);
}

// The closed form is the sum over the nodes; the bus is stations on a line. They know nothing of each other.
class CycleOfPolls : public testing::TestWithParam<std::pair<unsigned, unsigned>> {};

TEST_P(CycleOfPolls, IsWhatTheClosedFormSays) {
  const auto [dip, nodes] = GetParam();
  NetworkDescription description = NetworkDescription::even(dip, nodes, 1000);
  description.writes = false;
  RunningNetwork network(description, 7);
  const network::QuietRun run = network::run_quietly(network, 4, 7);
  kernel::Duration sum{};
  for (unsigned n = 0; n < nodes; ++n) {
    sum += reference_poll_time(description.rules, distance_of(description.rules, n, nodes, 1000)).total();
  }
  ASSERT_EQ(run.cycles.size(), 4U);
  EXPECT_EQ(run.counts.detected + run.counts.retried, 0U);
  EXPECT_EQ(run.counts.accepted_wrong() + run.counts.missed_outputs, 0U);
  for (const kernel::Duration cycle : run.cycles) {
    EXPECT_LE(std::chrono::abs(cycle - sum), kernel::kNanosecond * nodes)
        << kernel::describe(cycle) << " instead of " << kernel::describe(sum);
  }
}

INSTANTIATE_TEST_SUITE_P(OfBuses, CycleOfPolls,
                         testing::Values(std::pair{0U, 1U}, std::pair{0U, 31U}, std::pair{0U, 99U},
                                         std::pair{1U, 31U}, std::pair{2U, 5U}, std::pair{4U, 3U},
                                         std::pair{7U, 2U}));

// Writes and polls in turn, below the time after which a host refreshes.
TEST(ValveBusTiming, ACycleOfWritesAndPollsIsTheSumOfBoth) {
  for (const unsigned nodes : {1U, 2U, 8U, 20U}) {
    RunningNetwork network(NetworkDescription::even(0, nodes, 1000), 7);
    const network::CycleKind kind = network.cycles().front();
    ASSERT_FALSE(kind.is_bound) << nodes;
    const network::QuietRun run = network::run_quietly(network, 10, 7);
    ASSERT_EQ(run.cycles.size(), 10U);
    EXPECT_EQ(run.counts.detected + run.counts.accepted_wrong() + run.counts.missed_outputs, 0U) << nodes;
    for (const kernel::Duration cycle : run.cycles) {
      EXPECT_LE(std::chrono::abs(cycle - kind.theory), kernel::kMicrosecond)
          << nodes << " nodes: " << kernel::describe(cycle) << " instead of "
          << kernel::describe(kind.theory);
    }
  }
}

TEST(ValveBusTiming, WithRefreshesTheFormIsABound) {
  RunningNetwork network(NetworkDescription::even(0, 99, 1000), 7);
  const network::CycleKind kind = network.cycles().front();
  EXPECT_TRUE(kind.is_bound);
  const network::QuietRun run = network::run_quietly(network, 5, 7);
  ASSERT_EQ(run.cycles.size(), 5U);
  EXPECT_EQ(run.counts.detected + run.counts.accepted_wrong() + run.counts.missed_outputs, 0U);
  for (const kernel::Duration cycle : run.cycles) EXPECT_LE(cycle, kind.theory);
}

}  // namespace
}  // namespace fieldproof::valve_bus
