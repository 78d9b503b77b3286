#include "harness/traffic/token_traffic.hpp"

#include <gtest/gtest.h>

#include "harness/kernel/error.hpp"
#include "harness/traffic/milliseconds.hpp"
#include "harness/traffic/token_rotation.hpp"

namespace fieldproof::traffic {
namespace {

using kernel::kMicrosecond;
using kernel::kMillisecond;

// The paper's traffic, whose lower priority is the lowest one here.
TokenTraffic as_token_traffic(const UrgentTraffic& paper) {
  TokenTraffic traffic;
  TokenNode node;
  node.overhead = paper.empty_rotation / paper.urgent_queues;
  node.streams[kUrgent] = {paper.urgent_per_ms, paper.urgent_length};
  node.streams[kTimeAvailable] = {paper.available_per_ms, paper.available_length};
  traffic.nodes.assign(paper.urgent_queues, node);
  traffic.idle = paper.empty_rotation - paper.urgent_queues * node.overhead;
  traffic.target = paper.target_rotation;
  traffic.rule = TokenRule::all_or_urgent;
  return traffic;
}

// Four nodes that have nothing in common, three priorities.
TokenTraffic mixed_traffic() {
  TokenTraffic traffic;
  for (int n = 1; n <= 4; ++n) {
    TokenNode node;
    node.overhead = n * 400 * kMicrosecond;
    node.streams[kUrgent] = {0.01 * n, 600 * kMicrosecond};
    node.streams[kNormal] = {0.02, n * 300 * kMicrosecond};
    node.streams[kTimeAvailable] = {0.05 / n, 1'200 * kMicrosecond};
    traffic.nodes.push_back(node);
  }
  traffic.target = 14 * kMillisecond;
  return traffic;
}

class SameAsTheFastToken : public testing::TestWithParam<std::pair<double, int>> {};

TEST_P(SameAsTheFastToken, ToTheDigit) {
  const auto [load, target_us] = GetParam();
  UrgentTraffic paper = paper_traffic(load, 1, 1, target_us * kMicrosecond);
  paper.empty_rotation += kernel::kPicosecond;  // the division leaves something over
  const TokenFigures fast =
      rotate_token(paper, {.seed = 5, .urgent_packets = 50'000, .warm_up_rotations = 500});
  const TrafficFigures it =
      pass_token(as_token_traffic(paper), {.seed = 5, .urgent_packets = 50'000, .warm_up_rotations = 500});
  EXPECT_EQ(it.all[kUrgent].mean_delay, fast.mean_delay);
  EXPECT_EQ(it.all[kUrgent].standard_error, fast.standard_error);
  EXPECT_EQ(it.mean_rotation, fast.mean_rotation);
  EXPECT_EQ(it.rotation_error, fast.rotation_error);
  EXPECT_EQ(it.admitted_to[kTimeAvailable], fast.priority_1);
}

INSTANTIATE_TEST_SUITE_P(OfThePaper, SameAsTheFastToken,
                         testing::Values(std::pair{0.2, 20'000}, std::pair{0.35, 34'816},
                                         std::pair{0.35, 25'000}, std::pair{0.5, 30'000}));

TEST(TokenTraffic, AsMuchLeavesAsArrives) {
  const TokenTraffic traffic = mixed_traffic();
  const TrafficFigures it = pass_token(traffic, {.seed = 2, .urgent_packets = 300'000});
  const double expected = ms(traffic.empty_rotation()) / (1 - traffic.load());
  EXPECT_NEAR(it.mean_rotation, expected, 0.002 * expected + 4 * it.rotation_error);
  for (const auto& node : it.nodes) {
    for (const StreamFigures& stream : node) {
      EXPECT_FALSE(stream.is_unstable);
      EXPECT_NEAR(stream.leave_per_ms, stream.arrive_per_ms, 0.02 * stream.arrive_per_ms);
      EXPECT_GE(stream.largest_delay, stream.mean_delay);
    }
  }
}

TEST(TokenTraffic, AScheduleTakesItsTimeAndTheTokenWaitsBeforeIt) {
  TokenTraffic traffic = mixed_traffic();
  const double without = pass_token(traffic, {.seed = 2, .urgent_packets = 200'000}).all[kUrgent].mean_delay;
  traffic.macrocycle = 50 * kMillisecond;
  traffic.schedule = {{5 * kMillisecond, 2 * kMillisecond}, {30 * kMillisecond, 3 * kMillisecond}};
  traffic.target = 40 * kMillisecond;
  EXPECT_DOUBLE_EQ(traffic.scheduled_load(), 0.1);
  const TrafficFigures it = pass_token(traffic, {.seed = 2, .urgent_packets = 300'000});
  EXPECT_GT(it.waits_for_schedule, 0);
  const double expected =
      ms(traffic.empty_rotation()) / (1 - traffic.load() - traffic.scheduled_load() - it.waits_for_schedule);
  EXPECT_NEAR(it.mean_rotation, expected, 0.005 * expected + 4 * it.rotation_error);
  EXPECT_GT(it.all[kUrgent].mean_delay, without);
}

TEST(TokenTraffic, AQueueThatGrowsIsNamedAndNotAveraged) {
  TokenTraffic traffic = mixed_traffic();
  traffic.nodes[2].streams[kTimeAvailable].per_ms = 1;
  const TrafficFigures it = pass_token(traffic, {.seed = 2, .urgent_packets = 100'000});
  EXPECT_TRUE(it.nodes[2][kTimeAvailable].is_unstable);
  EXPECT_TRUE(it.all[kTimeAvailable].is_unstable);
  EXPECT_EQ(it.all[kTimeAvailable].mean_delay, 0);
  EXPECT_LT(it.nodes[2][kTimeAvailable].leave_per_ms, 1);
  EXPECT_FALSE(it.all[kUrgent].is_unstable);
}

TEST(TokenTraffic, APacketThatFitsNoGapIsRefused) {
  TokenTraffic traffic = mixed_traffic();
  traffic.macrocycle = 10 * kMillisecond;
  traffic.schedule = {{0 * kMillisecond, 1 * kMillisecond}, {5 * kMillisecond, 1 * kMillisecond}};
  traffic.nodes[0].streams[kNormal] = {0.01, 5 * kMillisecond};
  EXPECT_THROW(check(traffic), kernel::Error);
  traffic.nodes[0].streams[kNormal].length = 4 * kMillisecond;
  EXPECT_NO_THROW(check(traffic));
}

TEST(TokenTraffic, OneStepIsOnePriority) {
  TokenTraffic traffic = mixed_traffic();
  traffic.target = 1 * kMillisecond;  // shorter than the empty rotation: nothing but urgent packets
  const TrafficFigures starved = pass_token(traffic, {.urgent_packets = 10'000, .warm_up_rotations = 5});
  EXPECT_EQ(starved.admitted_to[kUrgent], 1);
  traffic.target = 7 * kMillisecond;
  const TrafficFigures tight = pass_token(traffic, {.urgent_packets = 10'000});
  EXPECT_GT(tight.admitted_to[kNormal], 0);
}

TEST(TokenTraffic, SharesWithinABoundGrowWithIt) {
  TrafficRun run{.urgent_packets = 50'000, .bound = 4 * kMillisecond};
  const StreamFigures tight = pass_token(mixed_traffic(), run).all[kUrgent];
  run.bound = 8 * kMillisecond;
  const StreamFigures wide = pass_token(mixed_traffic(), run).all[kUrgent];
  EXPECT_GT(tight.within, 0);
  EXPECT_LT(tight.within, wide.within);
  EXPECT_LT(wide.least_within, wide.within);
  EXPECT_GT(wide.least_within, 0);
  EXPECT_EQ(tight.mean_delay, wide.mean_delay);
}

TEST(TokenTraffic, WhatCannotBeSimulatedIsRefused) {
  const auto refused = [](auto&& change) {
    TokenTraffic traffic = mixed_traffic();
    traffic.macrocycle = 10 * kMillisecond;
    change(traffic);
    EXPECT_THROW(check(traffic), kernel::Error);
  };
  refused([](TokenTraffic& t) { t.nodes.clear(); });
  refused([](TokenTraffic& t) { t.nodes.resize(65, t.nodes.front()); });
  refused([](TokenTraffic& t) { t.nodes[0].overhead = {}; });
  refused([](TokenTraffic& t) { t.nodes[0].streams[kUrgent].per_ms = -1; });
  refused([](TokenTraffic& t) { t.nodes[0].streams[kUrgent].per_ms = 1e-9; });
  refused([](TokenTraffic& t) { t.schedule = {{8 * kMillisecond, 3 * kMillisecond}}; });
  refused([](TokenTraffic& t) { t.schedule = {{{}, 3 * kMillisecond}, {kMillisecond, kMillisecond}}; });
  refused([](TokenTraffic& t) { t.schedule = {{{}, 9 * kMillisecond}}; });
  TokenTraffic quiet = mixed_traffic();
  for (TokenNode& node : quiet.nodes) node.streams[kUrgent].per_ms = 0;
  EXPECT_THROW(pass_token(quiet, {}), kernel::Error);
}

}  // namespace
}  // namespace fieldproof::traffic
