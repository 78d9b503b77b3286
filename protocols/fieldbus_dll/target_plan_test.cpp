#include "protocols/fieldbus_dll/target_plan.hpp"

#include <gtest/gtest.h>

#include "harness/kernel/sanitized.hpp"
#include "harness/traffic/milliseconds.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

using kernel::kMicrosecond;
using kernel::kMillisecond;

// Eight equal nodes with much time-available data.
traffic::TokenTraffic planned_traffic(double available_per_ms) {
  traffic::TokenTraffic traffic;
  traffic::TokenNode node;
  node.overhead = 1 * kMillisecond;
  node.streams[traffic::kUrgent] = {0.01, 600 * kMicrosecond};
  node.streams[traffic::kTimeAvailable] = {available_per_ms, 2 * kMillisecond};
  traffic.nodes.assign(8, node);
  return traffic;
}

TEST(TargetPlan, AWideBoundTakesTheTargetThatAdmitsAll) {
  const TargetPlan plan = plan_target(planned_traffic(0.01), {.at_most = 200 * kMillisecond}, 1);
  ASSERT_TRUE(plan.is_proven);
  EXPECT_EQ(plan.searched.size(), kTargets);
  for (const TargetRun& run : plan.searched) EXPECT_EQ(run.target % kMicrosecond, kernel::Duration{});
  EXPECT_EQ(plan.tried.back().target, plan.searched.back().target);
  EXPECT_EQ(plan.tried.back().figures.admitted_to[traffic::kTimeAvailable], 1);
  EXPECT_GT(plan.tried.back().error, 0);
}

// More time-available data than the token carries: only a short target keeps them from urgent packets.
TEST(TargetPlan, ATightBoundCostsTimeAvailableData) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: the tests beside it show a sanitizer the same code";
  const traffic::TokenTraffic traffic = planned_traffic(0.2);
  const TargetPlan wide = plan_target(traffic, {.at_most = 200 * kMillisecond}, 1);
  const TargetPlan tight = plan_target(traffic, {.at_most = 9 * kMillisecond}, 1);
  ASSERT_TRUE(wide.is_proven);
  ASSERT_TRUE(tight.is_proven);
  EXPECT_LT(tight.tried.back().target, wide.tried.back().target);
  EXPECT_LE(tight.tried.back().reached + tight.tried.back().error, 9);
  EXPECT_TRUE(wide.tried.back().figures.nodes[0][traffic::kTimeAvailable].is_unstable);
}

TEST(TargetPlan, WhatCannotBeMetIsNotProvenAndTheBestIsTold) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: the tests beside it show a sanitizer the same code";
  const TargetPlan plan = plan_target(planned_traffic(0.2), {.at_most = 2 * kMillisecond}, 1);
  EXPECT_FALSE(plan.is_proven);
  EXPECT_TRUE(plan.tried.empty());
  for (const TargetRun& run : plan.searched) EXPECT_GE(run.reached, plan.searched[plan.best].reached);
}

TEST(TargetPlan, AShareIsProvenWithItsConfidence) {
  const TargetPlan plan = plan_target(planned_traffic(0.01), {.at_most = 25 * kMillisecond, .share = 0.9}, 1);
  ASSERT_TRUE(plan.is_proven);
  EXPECT_GE(plan.tried.back().reached - plan.tried.back().error, 0.9);
  EXPECT_EQ(plan.tried.back().reached,
            plan_target(planned_traffic(0.01), {.at_most = 25 * kMillisecond, .share = 0.9}, 1)
                .tried.back()
                .reached);
}

// Packets so rare that the visits of the token end the simulation still have an error to their mean.
TEST(TargetPlan, RarePacketsAreProvenWithAnErrorOfTheirOwn) {
  traffic::TokenTraffic traffic = planned_traffic(0);
  for (traffic::TokenNode& node : traffic.nodes) node.streams[traffic::kUrgent].per_ms = 2e-4;
  const TargetPlan plan = plan_target(traffic, {.at_most = 20 * kMillisecond}, 1);
  ASSERT_TRUE(plan.is_proven);
  EXPECT_GT(plan.tried.back().error, 0);
}

// What no rotation admits has no delay, and is not harmed least for that.
TEST(TargetPlan, AShortTargetDoesNotStarveRareTimeAvailableData) {
  traffic::TokenTraffic traffic = planned_traffic(2e-6);
  const TargetPlan plan = plan_target(traffic, {.at_most = 200 * kMillisecond}, 1);
  EXPECT_TRUE(plan.searched.front().figures.all[traffic::kTimeAvailable].is_unstable);
  ASSERT_TRUE(plan.is_proven);
  EXPECT_GT(plan.tried.back().figures.all[traffic::kTimeAvailable].packets, 0U);
}

TEST(TargetPlan, ANodeWithFewPacketsDoesNotProveAShareByHavingNoMiss) {
  if (kernel::kIsSanitized)
    GTEST_SKIP() << "not applicable: the tests beside it show a sanitizer the same code";
  traffic::TokenTraffic traffic = planned_traffic(0.01);
  traffic.nodes[3].streams[traffic::kUrgent].per_ms = 1e-5;
  const DelayBound bound{.at_most = 40 * kMillisecond, .share = 0.9999};
  const TargetPlan plan = plan_target(traffic, bound, 1);
  EXPECT_FALSE(plan.is_proven);
  for (const TargetRun& tried : plan.tried) EXPECT_EQ(tried.worst_node, 3U);
}

// 628 packets in a second where 625 can go.
TEST(TargetPlan, UrgentQueuesThatGrowSlowlyAreNotAPlan) {
  traffic::TokenTraffic traffic = planned_traffic(0);
  traffic.nodes.resize(1);
  traffic.nodes[0].streams[traffic::kUrgent].per_ms = 0.628;
  const TargetPlan plan = plan_target(traffic, {.at_most = 10 * kernel::kSecond}, 1);
  EXPECT_FALSE(plan.is_proven);
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
