#include "protocols/bandwidth/proof.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/kernel/sanitized.hpp"
#include "protocols/bandwidth/sample_plans.hpp"
#include "protocols/bandwidth/stability.hpp"

namespace fieldproof::bandwidth {
namespace {

constexpr std::uint64_t kSlots = kernel::kIsSanitized ? 20'000 : kSlotsOfProof;

double share_of_slot(kernel::Duration duration, const WindowTraffic& traffic) {
  return static_cast<double>(duration.count()) / static_cast<double>(traffic.slot.count());
}

void expect_to_hold(const WindowTraffic& traffic) {
  const Proof proof = prove(traffic, 1, kSlots);
  EXPECT_GE(proof.slots(), kSlots * 9 / 10);
  for (const ProofRun& run : proof.runs) {
    EXPECT_EQ(run.figures.over_slot(), 0U) << run.name;
    EXPECT_EQ(run.figures.lost(), 0U) << run.name;
    EXPECT_EQ(run.figures.vacant(), 0U) << run.name;
    EXPECT_GT(run.figures.samplings(), 0U) << run.name;
    EXPECT_LE(run.figures.longest(), run.is_own_order ? proof.slowest_own : proof.slowest_of_all) << run.name;
  }
  EXPECT_TRUE(proof.holds_in_any_order());
  EXPECT_GE(share_of_slot(proof.longest(), traffic), 0.9) << "nobody has come near to the bound";
}

TEST(WindowProof, TheSafeLengthHoldsAgainstAllAdversaries) {
  expect_to_hold(traffic_of(whole_density(), 3'320));
}

TEST(WindowProof, TheSafeLengthHoldsWhereTheDensityIsFractional) {
  expect_to_hold(traffic_of(fractional_density(), 2'225));
}

TEST(WindowProof, TheSafeLengthHoldsBesideRealTimePackets) {
  Demand demand = fractional_density();
  demand.real_time_queues = 4;
  demand.real_time_packet = 250 * kernel::kMicrosecond;
  const Allocation allocation = allocate(demand);
  const auto us = allocation.longest_safe / kernel::kMicrosecond;
  expect_to_hold(traffic_of(demand, us));
}

TEST(WindowProof, ThePrintedLengthIsBrokenWhereTheDensityIsFractional) {
  const Proof proof = prove(traffic_of(fractional_density(), 2'485), 1, kSlots);
  EXPECT_FALSE(proof.holds());
  EXPECT_EQ(proof.slowest_own, 22'080 * kernel::kMicrosecond);
  std::uint64_t late = 0;
  for (const ProofRun& run : proof.runs) {
    late += run.figures.over_slot();
    if (!run.figures.first_late) continue;
    const std::string story = story_of_late(run);
    EXPECT_THAT(story, testing::HasSubstr("over T_1")) << run.name;
    EXPECT_THAT(story, testing::HasSubstr("8 non-real-time packets")) << run.name;
  }
  EXPECT_GT(late, 0U);
  EXPECT_GT(proof.longest(), 20'000 * kernel::kMicrosecond);
  EXPECT_LE(proof.longest(), proof.slowest_of_all);
}

// As long as the data of a slot are few: controllers wait for their first datum.
TEST(WindowProof, SlotsOfTheStartHaveALimitOfTheirOwn) {
  const Allocation allocation = allocate(whole_density());
  EXPECT_LT(allocation.longest_from_start, allocation.longest_safe);
  const auto us = allocation.longest_from_start / kernel::kMicrosecond;
  const Proof proof = prove(traffic_of(whole_density(), us), 1, kSlots / 10);
  for (const ProofRun& run : proof.runs) EXPECT_LE(run.figures.longest_of_start, allocation.slot) << run.name;
}

TEST(WindowProof, TheSafeLengthIsNotAlwaysEnoughForTheFirstSlot) {
  WindowTraffic traffic = traffic_of(whole_density(), 3'320);
  for (std::uint8_t n = 0; n < 4; ++n) {
    traffic.loops[n].sensor = n;
    traffic.loops[n].controller = static_cast<std::uint8_t>(n + 4);
  }
  const WindowFigures figures = run_windows(traffic, {.slots = kSlots / 100,
                                                      .real_time = Load::none,
                                                      .non_real_time = Load::saturated,
                                                      .first_node = 3,
                                                      .begins_in_packet = true});
  EXPECT_EQ(figures.longest_of_start, 25'840 * kernel::kMicrosecond) << "7 packets, 4 data, one rotation";
  EXPECT_EQ(figures.over_slot(), 0U) << "once controllers send, too";
}

TEST(WindowProof, OffTheCommonGridControllersSampleInVain) {
  for (const auto& [demand, packet] : {std::pair{whole_density(), 3'320}, {fractional_density(), 2'225}}) {
    WindowTraffic traffic = traffic_of(demand, packet);
    for (LoopTraffic& loop : traffic.loops) loop.skew = traffic.slot / 40 * 5;
    const WindowFigures figures =
        run_windows(traffic, {.slots = kSlots / 10, .real_time = Load::none, .non_real_time = Load::random});
    const double vacant =
        1e3 * static_cast<double>(figures.vacant()) / static_cast<double>(figures.samplings());
    EXPECT_GT(vacant, 110);
    EXPECT_LT(vacant, 155);
    EXPECT_LE(share_of_slot(figures.longest(), traffic), 1.0) << "no datum takes longer than a slot";
  }
}

TEST(WindowProof, TheSaturatedLoadIsThatOfTheFormula) {
  Demand with_real_time = fractional_density();
  with_real_time.real_time_queues = 5;
  with_real_time.real_time_packet = 150 * kernel::kMicrosecond;
  for (const auto& [demand, packet] : {std::pair{whole_density(), 3'320},
                                       {whole_density(), 1'111},
                                       {fractional_density(), 2'225},
                                       {fractional_density(), 700},
                                       {with_real_time, 1'700}}) {
    WindowTraffic traffic = traffic_of(demand, packet);
    for (QueueTraffic& queue : traffic.real_time) queue.mean_gap = 50 * kernel::kMillisecond;
    const WindowFigures figures =
        run_windows(traffic, {.slots = kSlots / 4, .non_real_time = Load::saturated});
    const double sent = static_cast<double>(figures.non_real_time.sent) / static_cast<double>(figures.slots) /
                        static_cast<double>(traffic.non_real_time.size());
    const double formula = stability(traffic, allocate(demand)).saturated_packets;
    EXPECT_NEAR(sent / formula, 1, kernel::kIsSanitized ? 6e-3 : 6e-4) << packet;
  }
}

TEST(WindowProof, QueuesGrowOverTheLoadOfTheFormulaAndNotUnderIt) {
  for (const auto& [demand, packet] : {std::pair{whole_density(), 3'320}, {fractional_density(), 2'225}}) {
    WindowTraffic traffic = traffic_of(demand, packet);
    const double most = stability(traffic, allocate(demand)).saturated_packets;
    for (const double load : {0.9, 1.1}) {
      const double gap = static_cast<double>(traffic.slot.count()) / (load * most);
      for (QueueTraffic& queue : traffic.non_real_time)
        queue.mean_gap = kernel::Duration{static_cast<std::int64_t>(gap)};
      const WindowFigures figures = run_windows(traffic, {.slots = kSlots / 10});
      EXPECT_EQ(figures.non_real_time.grows, load > 1) << load;
      EXPECT_EQ(stability(traffic, allocate(demand)).is_stable(), load < 1) << load;
      if (load < 1) {
        EXPECT_LT(figures.non_real_time.waiting, 200U);
      } else {
        EXPECT_GT(figures.non_real_time.waiting, figures.slots / 20);
      }
    }
  }
}

TEST(WindowProof, PolledNodesKeepTheSameLimits) {
  Demand demand = fractional_density();
  WindowTraffic traffic = traffic_of(demand, 2'225);
  traffic.overhead = 60 * kernel::kMicrosecond;
  traffic.empty_answer = 40 * kernel::kMicrosecond;
  const Proof proof = prove(traffic, 1, kSlots / 4);
  EXPECT_TRUE(proof.holds_in_any_order());
  EXPECT_LT(proof.slowest_of_all, traffic.slot) << "who sends a packet gives no empty answer";
}

TEST(WindowProof, IsTheSameEachTime) {
  const WindowTraffic traffic = traffic_of(fractional_density(), 2'225);
  const Proof one = prove(traffic, 7, 20'000);
  const Proof other = prove(traffic, 7, 20'000);
  ASSERT_EQ(one.runs.size(), other.runs.size());
  for (std::size_t n = 0; n < one.runs.size(); ++n) {
    EXPECT_EQ(one.runs[n].figures.visits, other.runs[n].figures.visits);
    EXPECT_EQ(one.runs[n].figures.longest(), other.runs[n].figures.longest());
  }
}

}  // namespace
}  // namespace fieldproof::bandwidth
