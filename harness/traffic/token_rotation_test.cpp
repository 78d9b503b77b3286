#include "harness/traffic/token_rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/kernel/error.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::traffic {
namespace {

using kernel::kMicrosecond;
using kernel::kMillisecond;

// Means of another simulation, in another language, with its half width of 95 %; standing [calc].
struct Simulated {
  const char* name;
  double load, urgent_share, available_share;
  int target_us;
  double delay, half_width, mean_rotation, priority_1;
};

class RotationOf : public testing::TestWithParam<Simulated> {};

TEST_P(RotationOf, IsThatOfTheOtherSimulation) {
  const Simulated& other = GetParam();
  const UrgentTraffic traffic =
      paper_traffic(other.load, other.urgent_share, other.available_share, other.target_us * kMicrosecond);
  const TokenFigures it = rotate_token(traffic, {.seed = 3});
  const double apart = std::hypot(it.standard_error, other.half_width / 1.96);
  EXPECT_NEAR(it.mean_delay, other.delay, 3 * apart + 0.005 * other.delay);
  EXPECT_NEAR(it.mean_rotation, other.mean_rotation, 0.001 * other.mean_rotation + 3 * it.rotation_error);
  EXPECT_NEAR(it.priority_1, other.priority_1, 0.005);
  // As many leave as arrive.
  EXPECT_NEAR(it.urgent_per_ms, traffic.urgent_per_ms, 0.005 * traffic.urgent_per_ms);
  EXPECT_NEAR(it.available_per_ms, traffic.available_per_ms, 0.005 * traffic.available_per_ms);
  EXPECT_NEAR(it.mean_rotation, 16 / (1 - other.load), 0.016 / (1 - other.load) + 3 * it.rotation_error);
}

INSTANTIATE_TEST_SUITE_P(
    OfSixteenNodes, RotationOf,
    testing::Values(Simulated{"LowShort", 0.2, 2, 1, 20'000, 12.6370, 0.0069, 20.0016, 0.62347},
                    Simulated{"LowLong", 0.2, 2, 1, 48'680, 12.6509, 0.0071, 19.9996, 1},
                    Simulated{"Middle", 0.35, 1, 1, 34'816, 16.5141, 0.0158, 24.6120, 0.9780},
                    Simulated{"High", 0.5, 1, 1, 30'000, 27.0057, 0.0343, 31.9959, 0.5010}),
    [](const auto& one) { return std::string(one.param.name); });

TEST(TokenRotation, SameSeedSameDelays) {
  const UrgentTraffic traffic = paper_traffic(0.35, 1, 1, 34'816 * kMicrosecond);
  const TokenRun run{.seed = 9, .urgent_packets = 10'000, .warm_up_rotations = 100};
  EXPECT_EQ(rotate_token(traffic, run).mean_delay, rotate_token(traffic, run).mean_delay);
  TokenRun other = run;
  other.seed = 10;
  EXPECT_NE(rotate_token(traffic, run).mean_delay, rotate_token(traffic, other).mean_delay);
}

// A token without traffic takes R; what arrives waits half of that on average.
TEST(TokenRotation, RarePacketsWaitHalfAnEmptyRotation) {
  UrgentTraffic traffic = paper_traffic(0.2, 1, 1, 20 * kMillisecond);
  traffic.urgent_per_ms = 1e-4;
  traffic.available_per_ms = 0;
  const TokenFigures it = rotate_token(
      traffic, {.urgent_packets = kernel::kIsSanitized ? 20'000U : 100'000U, .warm_up_rotations = 10});
  EXPECT_NEAR(it.mean_rotation, 16, 0.05);
  EXPECT_NEAR(it.mean_delay, 8 + 0.6, 4 * it.standard_error + 0.02);
  EXPECT_DOUBLE_EQ(it.priority_1, 1);
}

TEST(TokenRotation, CapacityTellsWhichTimeAvailableQueuesGrow) {
  const UrgentTraffic starved = paper_traffic(0.35, 1, 1, 16'600 * kMicrosecond);
  EXPECT_LT(available_capacity(starved, 1), starved.available_per_ms);
  const TokenFigures it = rotate_token(starved, {.urgent_packets = 200'000});
  EXPECT_GT(it.longest_available, 1'000U);
  const UrgentTraffic served = paper_traffic(0.35, 1, 1, 34'816 * kMicrosecond);
  EXPECT_GT(available_capacity(served, 1), served.available_per_ms);
}

TEST(TokenRotation, UrgentQueuesThatGrowAreSaidSo) {
  UrgentTraffic traffic = paper_traffic(0.35, 1, 1, 34'816 * kMicrosecond);
  traffic.urgent_per_ms = 10;
  EXPECT_TRUE(
      rotate_token(traffic, {.urgent_packets = 100'000'000, .warm_up_rotations = 10}).is_urgent_unstable);
}

TEST(TokenRotation, WithoutUrgentPacketsIsRefused) {
  UrgentTraffic traffic = paper_traffic(0.35, 1, 1, 34'816 * kMicrosecond);
  traffic.urgent_per_ms = 0;
  EXPECT_THROW(rotate_token(traffic, {}), kernel::Error);
}

}  // namespace
}  // namespace fieldproof::traffic
