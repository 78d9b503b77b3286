#include "protocols/bandwidth/allocation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/kernel/error.hpp"
#include "harness/kernel/random.hpp"
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
  const Allocation plan = allocate(whole_density());
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
  const Allocation plan = allocate(fractional_density());
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

TEST(Allocation, TheSharpRuleSamplesLessOftenWhereItMay) {
  Demand demand = sample_demand({60, 120, 121});
  EXPECT_EQ(everies(allocate(demand)), (std::vector<unsigned>{1, 2, 2})) << "5 T_1 allow two";
  demand.rule = Rule::sharp;
  EXPECT_EQ(everies(allocate(demand)), (std::vector<unsigned>{1, 4, 4}));
  demand.bounds[1] = us(119'999);
  EXPECT_EQ(everies(allocate(demand)), (std::vector<unsigned>{1, 2, 4}));
  demand.rule = Rule::hong;
  demand.bounds = {us(60'000), us(100'000), us(99'999)};
  EXPECT_EQ(everies(allocate(demand)), (std::vector<unsigned>{1, 2, 1}));
}

TEST(Allocation, OffsetsAreThoseOfTheOrderOfPeriods) {
  const Demand demand = sample_demand({340, 60, 180, 100});
  const Allocation plan = allocate(demand);
  EXPECT_EQ(everies(plan), (std::vector<unsigned>{8, 1, 4, 2}));
  EXPECT_EQ(offsets(plan), (Offsets{{2, 3}, {0, 0}, {0, 1}, {0, 1}}));
}

// For powers of two the loads differ by one at most, whatever the demand.
TEST(Allocation, SlotsAreBalanced) {
  kernel::Random random(3);
  for (int n = 0; n < 500; ++n) {
    Demand demand = sample_demand({});
    demand.nodes = kMostNodes;
    for (auto loops = random.between(1, 64); loops > 0; --loops)
      demand.bounds.push_back(us(random.between(30'000, 3'000'000)));
    demand.rule = random.chance(0.5) ? Rule::hong : Rule::sharp;
    const Allocation plan = allocate(demand);
    EXPECT_LE(plan.windows - plan.fewest, 1U);
    double density = 0;
    for (std::size_t loop = 0; loop < demand.bounds.size(); ++loop) {
      density += 2.0 / plan.loops[loop].every;
      EXPECT_LE(plan.loops[loop].longest_delay, demand.bounds[loop]);
    }
    EXPECT_EQ(plan.mean_load(), density) << "sums of powers of two are exact";
    EXPECT_EQ(plan.windows, static_cast<unsigned>(std::ceil(density)));
    EXPECT_EQ(plan.fewest, static_cast<unsigned>(std::floor(density)));
  }
}

// Another way to the same plan: whole microseconds, trial of each power of two and of each offset, slots
// counted one by one.
struct Trial {
  std::int64_t slot = 0;
  std::vector<unsigned> every{};
  Offsets offsets{};
  std::vector<unsigned> loads{};
};

Trial trial_of(const Demand& demand) {
  Trial trial;
  std::vector<std::int64_t> bounds;
  for (const kernel::Duration bound : demand.bounds) bounds.push_back(bound / kMicrosecond);
  trial.slot = *std::min_element(bounds.begin(), bounds.end()) / 3;
  unsigned slots = 1;
  for (const std::int64_t bound : bounds) {
    unsigned every = 1;
    const auto keeps = [&](std::int64_t k) {
      return demand.rule == Rule::hong ? 2 * k * trial.slot + trial.slot <= bound
                                       : k * trial.slot + 2 * trial.slot <= bound;
    };
    while (every < kMostSlots && keeps(std::int64_t{2} * every)) every *= 2;
    trial.every.push_back(every);
    slots = std::max(slots, every);
  }
  trial.loads.assign(slots, 0);
  trial.offsets.resize(bounds.size());
  for (unsigned every = 1; every <= slots; every *= 2) {
    for (std::size_t loop = 0; loop < bounds.size(); ++loop) {
      if (trial.every[loop] != every) continue;
      for (const bool is_controller : {false, true}) {
        unsigned best = 0;
        unsigned least = ~0U;
        for (unsigned offset = 0; offset < every; ++offset) {
          unsigned most = 0;
          for (unsigned slot = offset; slot < slots; slot += every) most = std::max(most, trial.loads[slot]);
          if (most < least) least = most, best = offset;
        }
        for (unsigned slot = best; slot < slots; slot += every) ++trial.loads[slot];
        (is_controller ? trial.offsets[loop].second : trial.offsets[loop].first) = best;
      }
    }
  }
  return trial;
}

TEST(Allocation, IsThatOfTrialAndError) {
  kernel::Random random(4);
  for (int n = 0; n < 300; ++n) {
    Demand demand = sample_demand({});
    demand.nodes = static_cast<unsigned>(random.between(24, 128));
    demand.rule = random.chance(0.5) ? Rule::hong : Rule::sharp;
    for (auto loops = random.between(1, 12); loops > 0; --loops)
      demand.bounds.push_back(us(random.between(10'000, 2'000'000)));
    const Allocation plan = allocate(demand);
    const Trial trial = trial_of(demand);
    EXPECT_EQ(plan.slot, us(trial.slot));
    EXPECT_EQ(everies(plan), trial.every);
    EXPECT_EQ(offsets(plan), trial.offsets);
    EXPECT_EQ(plan.loads, trial.loads);
    // The longest packet, by trial of each length of whole microseconds.
    const std::int64_t room = trial.slot - std::int64_t{demand.nodes} * 100;
    const auto fits = [&](std::int64_t length) {
      for (const unsigned data : plan.loads) {
        if (data > 0 && (std::int64_t{demand.nodes} - data + 1) * length + data * 400 > room) return false;
      }
      return true;
    };
    const std::int64_t longest = plan.longest_safe / kMicrosecond;
    if (longest < 0) continue;
    EXPECT_TRUE(fits(longest));
    EXPECT_FALSE(fits(longest + 1));
  }
}

TEST(Allocation, FitsUpToTheLastWindow) {
  Demand demand = whole_density();
  demand.periodic_packet = us(3'166);  // six and the server: 19996
  EXPECT_TRUE(allocate(demand).is_feasible());
  EXPECT_EQ(allocate(demand).most_windows, 6);
  demand.periodic_packet = us(3'167);
  const Allocation plan = allocate(demand);
  EXPECT_FALSE(plan.is_feasible());
  EXPECT_EQ(plan.most_windows, 5);
  const Remedy found = remedy(demand, plan);
  EXPECT_EQ(found.fastest, 0U);
  EXPECT_EQ(found.periodic_packet, us(3'166));
  EXPECT_EQ(found.overhead, us(99));
  EXPECT_EQ(found.loops_to_leave_out, 1U);
  demand.overhead = us(2'001);
  EXPECT_EQ(allocate(demand).most_windows, -1) << "not even the server has room";
  EXPECT_LT(allocate(demand).longest_safe, kernel::Duration::zero());
}

TEST(Allocation, ARemedyHelps) {
  Demand demand = whole_density();
  demand.periodic_packet = us(3'400);
  const Remedy found = remedy(demand, allocate(demand));
  ASSERT_TRUE(found.periodic_packet && found.bound);
  Demand shorter = demand;
  shorter.periodic_packet = *found.periodic_packet;
  EXPECT_TRUE(allocate(shorter).is_feasible());
  demand.bounds[found.fastest] = *found.bound;
  EXPECT_TRUE(allocate(demand).is_feasible());
}

TEST(Allocation, RefusesWhatNobodyCanPlan) {
  EXPECT_THROW(allocate(sample_demand({})), kernel::Error);
  EXPECT_THROW(allocate(sample_demand({60, 60, 60, 60, 60, 60})), kernel::Error) << "12 streams, 10 nodes";
  EXPECT_THROW(allocate(sample_demand({1'000'001})), kernel::Error);
  Demand demand = whole_density();
  demand.bounds[0] = us(3) - kernel::kPicosecond;
  EXPECT_THROW(allocate(demand), kernel::Error);
  demand.bounds[0] = us(3);
  EXPECT_EQ(allocate(demand).slot, us(1));
  demand.periodic_packet = -us(1);
  EXPECT_THROW(allocate(demand), kernel::Error);
}

}  // namespace
}  // namespace fieldproof::bandwidth
