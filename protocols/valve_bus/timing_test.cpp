#include "protocols/valve_bus/timing.hpp"

#include <gtest/gtest.h>

#include "harness/kernel/error.hpp"
#include "protocols/valve_bus/poll_run.hpp"

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
class PollCycle : public testing::TestWithParam<std::pair<unsigned, unsigned>> {};

TEST_P(PollCycle, IsWhatTheClosedFormSays) {
  const auto [dip, nodes] = GetParam();
  Rules rules;
  const PollRun run =
      run_polls(rules, {.dip = dip, .nodes = nodes, .length_m = 1000, .cycles = 4, .seed = 7});
  rules.bit_rate = dip_bit_rates()[dip];
  kernel::Duration sum{};
  for (unsigned n = 0; n < nodes; ++n) {
    sum += reference_poll_time(rules, distance_of(rules, n, nodes, 1000)).total();
  }
  ASSERT_EQ(run.cycles.size(), 4U);
  EXPECT_EQ(run.errors, 0U);
  EXPECT_EQ(run.wrong_responses, 0U);
  for (const kernel::Duration cycle : run.cycles) {
    EXPECT_LE(std::chrono::abs(cycle - sum), kernel::kNanosecond * nodes)
        << kernel::describe(cycle) << " instead of " << kernel::describe(sum);
  }
}

INSTANTIATE_TEST_SUITE_P(OfBuses, PollCycle,
                         testing::Values(std::pair{0U, 1U}, std::pair{0U, 31U}, std::pair{0U, 99U},
                                         std::pair{1U, 31U}, std::pair{2U, 5U}, std::pair{4U, 3U},
                                         std::pair{7U, 2U}));

TEST(PollRun, RefusesABusThatIsNone) {
  EXPECT_THROW(run_polls({}, {.nodes = 0}), kernel::Error);
  EXPECT_THROW(run_polls({}, {.nodes = 100}), kernel::Error);
  EXPECT_THROW(run_polls({}, {.dip = 8}), kernel::Error);
}

}  // namespace
}  // namespace fieldproof::valve_bus
