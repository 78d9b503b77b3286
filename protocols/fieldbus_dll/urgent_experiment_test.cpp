#include "protocols/fieldbus_dll/urgent_experiment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "harness/kernel/error.hpp"
#include "harness/kernel/sanitized.hpp"
#include "harness/traffic/token_rotation.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr kernel::Duration kLong = (kernel::kIsSanitized ? 5 : 40) * kernel::kSecond;

traffic::UrgentTraffic traffic_of(double load, int target_us) {
  return traffic::paper_traffic(load, 1, 1, target_us * kernel::kMicrosecond);
}

TEST(UrgentExperimentTest, ARotationWithoutPacketsIsThatOfThePaper) {
  traffic::UrgentTraffic traffic = traffic_of(0.2, 34'816);
  traffic.urgent_per_ms = 0;
  traffic.available_per_ms = 0;
  const ExperimentFigures found = run_urgent_experiment(traffic, kernel::kSecond, 1);
  EXPECT_EQ(found.urgent_packets, 0U);
  EXPECT_NEAR(found.mean_rotation, 16, 1e-9);
  EXPECT_EQ(found.priority_1, 1);
}

// Frames on a line and the simulation that has none agree within what chance allows.
TEST(UrgentExperimentTest, AgreesWithTheSimulationWithoutFrames) {
  for (kernel::FewerIfSanitized few(3);
       const auto& [load, target] : {std::pair{0.2, 20'000}, {0.35, 34'816}, {0.5, 48'680}}) {
    if (few.leaves_out()) continue;
    const traffic::UrgentTraffic traffic = traffic_of(load, target);
    const ExperimentFigures found = run_urgent_experiment(traffic, kLong, 1);
    const traffic::TokenFigures wanted = traffic::rotate_token(
        traffic, {.seed = 2, .urgent_packets = kernel::kIsSanitized ? 30'000U : 300'000U});
    EXPECT_NEAR(found.mean_delay, wanted.mean_delay,
                4 * std::hypot(found.standard_error, wanted.standard_error) + 0.005 * wanted.mean_delay)
        << load;
    EXPECT_NEAR(found.mean_rotation, 16 / (1 - load), 4 * found.rotation_error + 0.016) << load;
    EXPECT_NEAR(found.priority_1, wanted.priority_1, 0.05) << load;
  }
}

// A rotation that takes the target to the digit withdraws time-available data: 16.6 ms is one urgent packet.
TEST(UrgentExperimentTest, ARotationThatEqualsItsTargetIsTooLong) {
  traffic::UrgentTraffic traffic = traffic_of(0.35, 16'600);
  traffic.available_per_ms = 0;
  traffic.urgent_per_ms = 0.01;
  const double at = run_urgent_experiment(traffic, 5 * kernel::kSecond, 1).priority_1;
  traffic.target_rotation += 8 * kernel::kMicrosecond;
  const double above = run_urgent_experiment(traffic, 5 * kernel::kSecond, 1).priority_1;
  EXPECT_GT(above, at + 0.05);
}

TEST(UrgentExperimentTest, RefusesWhatIsNotThePapersLink) {
  traffic::UrgentTraffic traffic = traffic_of(0.2, 34'816);
  EXPECT_THROW(run_urgent_experiment(traffic, kernel::kMillisecond, 1), kernel::Error);
  EXPECT_THROW(run_urgent_experiment(traffic_of(1, 34'816), kernel::kSecond, 1), kernel::Error);
  traffic.urgent_queues = 15;
  EXPECT_THROW(run_urgent_experiment(traffic, kernel::kSecond, 1), kernel::Error);
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
