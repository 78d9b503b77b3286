#include "protocols/interbus/skew.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "harness/kernel/random.hpp"
#include "harness/measure/cyclic_copy.hpp"

namespace fieldproof::interbus {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kNanosecond;
using measure::aliased_frequency_hz;
using measure::highest_frequency_hz;
using measure::max_duty_error;
using measure::pulse_width;
using measure::PulseWidth;

constexpr Duration kBestCycle = 814 * kMicrosecond;        // of the paper, as it prints it
constexpr Duration kFormulaCycle = 814'800 * kNanosecond;  // F1, n = 4
constexpr Duration kFrame = 364'800 * kNanosecond;
constexpr LatchModel kModels[] = {LatchModel::same_instant, LatchModel::frame_edges,
                                  LatchModel::previous_frame};

double ratio(Duration a, Duration b) {
  return static_cast<double>(a.count()) / static_cast<double>(b.count());
}

Duration half_period(double frequency_hz) {
  return Duration{std::llround(0.5e12 / frequency_hz)};
}

// A network that knows nothing of the closed forms: it samples, copies and latches cycle by cycle.
struct CopySimulation {
  LatchModel model;
  Duration cycle;
  Duration frame;

  Duration sampled_at(std::int64_t k) const {
    return model == LatchModel::previous_frame ? (k - 1) * cycle + frame : k * cycle;
  }
  Duration latched_at(std::int64_t k) const {  // what was sampled in cycle k
    return model == LatchModel::same_instant ? (k + 1) * cycle : (k + 1) * cycle + frame;
  }

  struct Pulse {
    Duration rise{-1};  // at the output; -1: never
    Duration fall{-1};
  };

  Pulse run(Duration rise, Duration high) const {
    Pulse pulse;
    bool output = false;
    for (std::int64_t k = 0; pulse.fall < Duration::zero() && sampled_at(k) < rise + high + 3 * cycle; ++k) {
      const bool input = sampled_at(k) >= rise && sampled_at(k) < rise + high;
      if (input != output) (input ? pulse.rise : pulse.fall) = latched_at(k);
      output = input;
    }
    return pulse;
  }
};

struct Statistics {
  double sum = 0;
  double squares = 0;
  double absolute_error = 0;
  int pulses = 0;
  int lost = 0;
  std::map<std::int64_t, int> widths;  // in cycles
};

constexpr int kPulses = 50'000;

Statistics simulate_widths(double frequency_hz) {
  const CopySimulation simulation{LatchModel::frame_edges, kBestCycle, kFrame};
  const Duration high = half_period(frequency_hz);
  kernel::Random random(20240811);
  Statistics found;
  for (int n = 0; n < kPulses; ++n) {
    const Duration rise = 5 * kBestCycle + Duration{random.between(0, kBestCycle.count() - 1)};
    const auto pulse = simulation.run(rise, high);
    const bool is_lost = pulse.rise < Duration::zero();
    const Duration width = is_lost ? Duration::zero() : pulse.fall - pulse.rise;
    EXPECT_EQ(width % kBestCycle, Duration::zero());
    const double cycles = ratio(width, kBestCycle);
    found.sum += cycles;
    found.squares += cycles * cycles;
    found.absolute_error += std::abs(cycles - ratio(high, kBestCycle));
    found.lost += is_lost ? 1 : 0;
    ++found.widths[width / kBestCycle];
    ++found.pulses;
  }
  return found;
}

struct SkewRow {
  double frequency_hz;
  double high_in_cycles;
  std::int64_t cycles;
  double deviation;  // in cycles
  double lost;
};

// The table of the specification, three printed digits.
constexpr SkewRow kSkewTable[] = {{50, 12.285, 12, 0.451, 0}, {150, 4.095, 4, 0.293, 0},
                                  {200, 3.071, 3, 0.257, 0},  {500, 1.229, 1, 0.420, 0},
                                  {614, 1.0004, 1, 0.020, 0}, {700, 0.878, 0, 0.328, 0.1225}};

TEST(PulseWidthTest, ClosedFormsGiveTheTable) {
  for (const SkewRow& row : kSkewTable) {
    SCOPED_TRACE(row.frequency_hz);
    const PulseWidth width = pulse_width(half_period(row.frequency_hz), kBestCycle);
    EXPECT_NEAR(ratio(width.mean, kBestCycle), row.high_in_cycles, 5e-4);
    EXPECT_EQ(width.cycles, row.cycles);
    EXPECT_NEAR(ratio(width.standard_deviation, kBestCycle), row.deviation, 7e-4);
    EXPECT_NEAR(width.lost_probability, row.lost, 5e-5);
  }
}

TEST(PulseWidthTest, WidthsAreThoseOfTheTable) {
  const PulseWidth slow = pulse_width(half_period(50), kBestCycle);
  EXPECT_EQ(slow.shorter, 9'768 * kMicrosecond);
  EXPECT_EQ(slow.longer, 10'582 * kMicrosecond);
  const PulseWidth fast = pulse_width(half_period(150), kBestCycle);
  EXPECT_EQ(fast.shorter, 3'256 * kMicrosecond);
  EXPECT_EQ(fast.longer, 4'070 * kMicrosecond);
  EXPECT_NEAR(pulse_width(half_period(614), kBestCycle).probability_of_one_more, 4e-4, 5e-5);
}

TEST(PulseWidthTest, SimulationFindsTheClosedForms) {
  for (const SkewRow& row : kSkewTable) {
    SCOPED_TRACE(row.frequency_hz);
    const PulseWidth width = pulse_width(half_period(row.frequency_hz), kBestCycle);
    const Statistics found = simulate_widths(row.frequency_hz);
    const double mean = found.sum / kPulses;
    const double deviation = std::sqrt(std::max(0.0, found.squares / kPulses - mean * mean));
    EXPECT_NEAR(mean, row.high_in_cycles, 0.01);
    EXPECT_NEAR(deviation, ratio(width.standard_deviation, kBestCycle), 0.008);
    EXPECT_NEAR(found.absolute_error / kPulses, ratio(width.mean_absolute_error, kBestCycle), 0.01);
    EXPECT_NEAR(1.0 * found.lost / kPulses, width.lost_probability, 0.006);
    for (const auto& [cycles, count] : found.widths) {
      EXPECT_TRUE(cycles == width.cycles || cycles == width.cycles + 1) << cycles << " cycles, " << count;
    }
  }
}

TEST(PulseWidthTest, WholeNumbersOfCyclesHaveOneWidth) {
  const PulseWidth exact = pulse_width(3 * kBestCycle, kBestCycle);
  EXPECT_EQ(exact.cycles, 3);
  EXPECT_EQ(exact.probability_of_one_more, 0.0);
  EXPECT_EQ(exact.standard_deviation, Duration::zero());
  EXPECT_EQ(pulse_width(kBestCycle, kBestCycle).lost_probability, 0.0);
  EXPECT_GT(pulse_width(kBestCycle - Duration{1}, kBestCycle).lost_probability, 0.0);
  EXPECT_EQ(pulse_width(Duration::zero(), kBestCycle).lost_probability, 1.0);
}

TEST(EdgeDelayTest, ModelsDifferByTheirLatency) {
  const auto in_cycles = [](LatchModel model) {
    const EdgeDelay delay = edge_delay(model, kFormulaCycle, kFrame);
    EXPECT_EQ(delay.max - delay.min, kFormulaCycle);
    EXPECT_NEAR(ratio(delay.standard_deviation, kFormulaCycle), 0.2887, 5e-5);
    return std::vector{ratio(delay.min, kFormulaCycle), ratio(delay.mean, kFormulaCycle),
                       ratio(delay.max, kFormulaCycle)};
  };
  EXPECT_EQ(in_cycles(LatchModel::same_instant), (std::vector{1.0, 1.5, 2.0}));
  EXPECT_EQ(in_cycles(LatchModel::previous_frame), (std::vector{2.0, 2.5, 3.0}));
  const auto default_model = in_cycles(LatchModel::frame_edges);
  EXPECT_NEAR(default_model[0], 1.448, 5e-4);
  EXPECT_NEAR(default_model[1], 1.948, 5e-4);
  EXPECT_NEAR(default_model[2], 2.448, 5e-4);
}

TEST(EdgeDelayTest, RootMeanSquareOfTheEdgeErrorIsThePrintedOne) {
  EXPECT_NEAR(
      ratio(edge_delay(LatchModel::same_instant, kBestCycle, kFrame).standard_deviation, kMicrosecond), 235.0,
      0.05);
}

TEST(EdgeDelayTest, SimulationFindsTheClosedForms) {
  for (const LatchModel model : kModels) {
    const CopySimulation simulation{model, kFormulaCycle, kFrame};
    const EdgeDelay expected = edge_delay(model, kFormulaCycle, kFrame);
    kernel::Random random(7);
    double sum = 0;
    double squares = 0;
    Duration least = Duration::max();
    Duration most = Duration::zero();
    for (int n = 0; n < kPulses; ++n) {
      const Duration rise = 5 * kFormulaCycle + Duration{random.between(0, kFormulaCycle.count() - 1)};
      const Duration delay = simulation.run(rise, 4 * kFormulaCycle).rise - rise;
      least = std::min(least, delay);
      most = std::max(most, delay);
      sum += ratio(delay, kFormulaCycle);
      squares += ratio(delay, kFormulaCycle) * ratio(delay, kFormulaCycle);
    }
    const double mean = sum / kPulses;
    EXPECT_GE(least, expected.min);
    EXPECT_LE(most, expected.max);
    EXPECT_NEAR(ratio(least, expected.min), 1.0, 1e-3);
    EXPECT_NEAR(ratio(most, expected.max), 1.0, 1e-3);
    EXPECT_NEAR(mean, ratio(expected.mean, kFormulaCycle), 0.006);
    EXPECT_NEAR(std::sqrt(squares / kPulses - mean * mean), 0.2887, 0.003);
  }
}

TEST(EdgeDelayTest, PhaseLagIsThatOfTheTable) {
  const auto lag = [](double f) {
    return mean_phase_lag_degrees(LatchModel::frame_edges, kBestCycle, kFrame, f);
  };
  EXPECT_NEAR(lag(50), 28.5, 0.05);
  EXPECT_NEAR(lag(150), 85.6, 0.05);
  EXPECT_NEAR(lag(200), 114, 0.5);
  EXPECT_NEAR(lag(500), 285, 0.5);
}

TEST(LostPulseTest, SurvivorsAboveTheHighestFrequencyAreLaterByHalfTheirWidth) {
  const Duration high = half_period(700);
  const CopySimulation simulation{LatchModel::frame_edges, kBestCycle, kFrame};
  kernel::Random random(700);
  double sum = 0;
  int survivors = 0;
  for (int n = 0; n < kPulses; ++n) {
    const Duration rise = 5 * kBestCycle + Duration{random.between(0, kBestCycle.count() - 1)};
    const auto pulse = simulation.run(rise, high);
    if (pulse.rise < Duration::zero()) continue;
    ++survivors;
    sum += ratio(pulse.rise - rise, kBestCycle);
  }
  const Duration expected = mean_delay_of_survivors(LatchModel::frame_edges, kBestCycle, kFrame, high);
  EXPECT_NEAR(sum / survivors, ratio(expected, kBestCycle), 0.006);
}

TEST(LostPulseTest, HighestFrequenciesArePrintedOnes) {
  EXPECT_NEAR(highest_frequency_hz(kBestCycle), 614.25, 0.005);
  EXPECT_NEAR(highest_frequency_hz(755 * kMicrosecond), 662, 0.5);
  EXPECT_NEAR(highest_frequency_hz(860 * kMicrosecond), 581, 0.5);
  EXPECT_NEAR(highest_frequency_hz(kBestCycle, 0.25), 614.25 / 2, 0.005);
  EXPECT_NEAR(highest_frequency_hz(kBestCycle, 0.5, 1), 614.25 / 2, 0.005);
  EXPECT_NEAR(highest_frequency_hz(kBestCycle, 0.5, 5), 614.25 / 6, 0.005);
}

TEST(LostPulseTest, DutyErrorGrowsWithFrequency) {
  EXPECT_NEAR(max_duty_error(50, kBestCycle), 0.0407, 5e-5);
  EXPECT_NEAR(max_duty_error(150, kBestCycle), 0.122, 5e-4);
  EXPECT_NEAR(max_duty_error(200, kBestCycle), 0.163, 5e-4);
  EXPECT_NEAR(max_duty_error(614, kBestCycle), 0.500, 5e-4);
}

TEST(LostPulseTest, AliasIsTheDistanceToTheNearestMultipleOfTheCycleRate) {
  EXPECT_NEAR(aliased_frequency_hz(100, kernel::kMillisecond), 100, 1e-9);
  EXPECT_NEAR(aliased_frequency_hz(1'100, kernel::kMillisecond), 100, 1e-9);
  EXPECT_NEAR(aliased_frequency_hz(1'900, kernel::kMillisecond), 100, 1e-9);
}

// Good cycles take one slot, bad ones `lost` slots. An edge in slot s would be sampled at its end and be at
// the output two good cycles later.
double simulated_extra_delay(double reject, unsigned lost, double& without_extra) {
  kernel::Random random(99);
  std::vector<std::int64_t> starts;  // of good cycles
  std::int64_t slot = 0;
  while (slot < 400'000) {
    if (random.chance(reject)) {
      slot += lost;
    } else {
      starts.push_back(slot++);
    }
  }
  double sum = 0;
  int edges = 0;
  int clean = 0;
  std::size_t next = 0;
  for (std::int64_t edge = 0; edge + 1 < slot - 1'000; ++edge) {
    while (starts[next] <= edge) ++next;
    // The first good cycle carries it to the master, the second one back; without errors the second starts 2
    // slots after that of the edge.
    const std::int64_t extra = starts[next + 1] - (edge + 2);
    sum += static_cast<double>(extra);
    clean += extra == 0 ? 1 : 0;
    ++edges;
  }
  without_extra = 1.0 * clean / edges;
  return sum / edges;
}

TEST(ExtraDelayTest, SimulationFindsTheClosedForms) {
  for (const double reject : {0.01, 0.1, 0.3}) {
    for (const unsigned lost : {1U, 2U, 5U}) {
      SCOPED_TRACE(testing::Message() << reject << " rejected, " << lost << " lost");
      double clean = 0;
      const double extra = simulated_extra_delay(reject, lost, clean);
      const double expected = ratio(mean_extra_delay_at_any_instant(reject, lost, kBestCycle), kBestCycle);
      EXPECT_NEAR(extra / expected, 1.0, 0.06);
      if (lost == 1) {
        EXPECT_NEAR(clean, probability_of_no_extra_delay(reject), 0.005);
      }
    }
  }
}

TEST(ExtraDelayTest, OneLostCycleHasNoRecoveryToComeInto) {
  EXPECT_EQ(mean_extra_delay(0.1, 1, kBestCycle), mean_extra_delay_at_any_instant(0.1, 1, kBestCycle));
  EXPECT_EQ(mean_extra_delay(0.0, 5, kBestCycle), Duration::zero());
  EXPECT_EQ(mean_extra_delay(0.5, 2, kBestCycle), 4 * kBestCycle);
  EXPECT_GT(mean_extra_delay_at_any_instant(0.1, 5, kBestCycle), mean_extra_delay(0.1, 5, kBestCycle));
}

}  // namespace
}  // namespace fieldproof::interbus
