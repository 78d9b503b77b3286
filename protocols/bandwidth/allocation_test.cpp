#include "protocols/bandwidth/allocation.hpp"

#include <gtest/gtest.h>

#include "protocols/bandwidth/sample_plans.hpp"

namespace fieldproof::bandwidth {
namespace {

using kernel::kMicrosecond;

constexpr kernel::Duration us(std::int64_t count) {
  return count * kMicrosecond;
}

std::vector<unsigned> everies(const Allocation& allocation) {
  std::vector<unsigned> all;
  for (const LoopShare& loop : allocation.loops) all.push_back(loop.every);
  return all;
}

std::vector<std::pair<unsigned, unsigned>> offsets(const Allocation& allocation) {
  std::vector<std::pair<unsigned, unsigned>> all;
  for (const LoopShare& loop : allocation.loops) all.emplace_back(loop.sensor_offset, loop.controller_offset);
  return all;
}

using Offsets = std::vector<std::pair<unsigned, unsigned>>;

TEST(Allocation, FirstPlanAsWorkedOut) {
  const Allocation plan = allocate(first_plan());
  EXPECT_EQ(plan.slot, us(20'000));
  EXPECT_EQ(everies(plan), (std::vector<unsigned>{1, 1, 2, 2}));
  EXPECT_EQ(plan.windows, 6U);
  EXPECT_EQ(plan.fewest, 6U);
  EXPECT_EQ(plan.most_windows, 47);
  EXPECT_EQ(plan.rotation, us(1'000));
  EXPECT_EQ(plan.periodic_interval, us(3'400));
  EXPECT_EQ(plan.longest_printed, us(3'320));
  EXPECT_EQ(plan.longest_safe, us(3'320));
  EXPECT_EQ(plan.longest_for_real_time, us(1'900));
  EXPECT_EQ(offsets(plan), (Offsets{{0, 0}, {0, 0}, {0, 1}, {0, 1}}));
  EXPECT_EQ(plan.loads, (std::vector<unsigned>{6, 6}));
}

TEST(Allocation, SecondPlanAsWorkedOut) {
  const Allocation plan = allocate(second_plan());
  EXPECT_EQ(plan.slot, us(20'000));
  EXPECT_EQ(everies(plan), (std::vector<unsigned>{1, 2, 4, 8}));
  EXPECT_EQ(plan.windows, 4U);
  EXPECT_EQ(plan.fewest, 3U);
  EXPECT_EQ(plan.most_windows, 47);
  EXPECT_EQ(plan.periodic_interval, us(2'600));
  EXPECT_EQ(plan.longest_printed, us(2'485));
  EXPECT_EQ(plan.longest_safe, us(2'225));
  EXPECT_EQ(plan.longest_for_real_time, us(1'900));
  EXPECT_EQ(offsets(plan), (Offsets{{0, 0}, {0, 1}, {0, 1}, {2, 3}}));
  EXPECT_EQ(plan.loads, (std::vector<unsigned>{4, 4, 4, 4, 4, 4, 3, 3}));
  EXPECT_EQ(plan.mean_load(), 3.75);
  EXPECT_EQ(plan.busy_slots(), 1);
}

}  // namespace
}  // namespace fieldproof::bandwidth
