#include "emc/coupling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

void expect_near(double measured, double figure, double part = 0.01) {
  EXPECT_NEAR(measured, figure, figure * part);
}

TEST(CouplingTest, PeaksBehindTheClampAreThoseCalculated) {
  const auto peak = [](double pf, double ohm) {
    Coupling coupling;
    coupling.clamp_pf = pf;
    coupling.common_mode_ohm = ohm;
    return LineResponse(coupling).coupled_peak();
  };
  expect_near(peak(100, 75), 0.417);
  expect_near(peak(200, 75), 0.483);
  expect_near(peak(1000, 50), 0.468);
}

// A network in place of the clamp passes almost the whole pulse, divided by the impedances.
TEST(CouplingTest, ACouplingNetworkPassesThePulse) {
  Coupling coupling;
  coupling.method = CouplingMethod::coupling_network;
  coupling.common_mode_ohm = 50;
  expect_near(LineResponse(coupling).coupled_peak(), 0.5);
}

// The peak of a pulse after a low-pass alone. The clamp is made to pass the pulse as it is.
TEST(CouplingTest, TheFilterReducesThePulseAsCalculated) {
  const auto peak = [](double mhz) {
    Coupling coupling;
    coupling.method = CouplingMethod::coupling_network;
    coupling.common_mode_ohm = 150;
    coupling.direct_part = 1;
    coupling.ringing_part = 0;
    coupling.filter_mhz = mhz;
    return LineResponse(coupling).differential_peak() / (150.0 / 200.0);
  };
  // The undershoot after 33 nF takes a little of the slow ones.
  expect_near(peak(0.1), 0.036, 0.03);
  expect_near(peak(1), 0.236, 0.02);
  expect_near(peak(2), 0.364, 0.02);
  expect_near(peak(5), 0.570);
  expect_near(peak(10), 0.728);
  expect_near(peak(16), 0.821);
  expect_near(peak(50), 0.964);
}

TEST(CouplingTest, RefusesParametersOutOfRange) {
  for (const CouplingParameter& parameter : coupling_parameters()) {
    for (const double value : {parameter.smallest, parameter.largest}) {
      Coupling coupling;
      coupling.bit_v = 3;
      coupling.*parameter.member = value;
      EXPECT_NO_THROW(LineResponse{coupling}) << parameter.name << " " << value;
    }
    for (const double value :
         {parameter.smallest - 0.001, parameter.largest + 0.001, std::numeric_limits<double>::quiet_NaN()}) {
      if (value >= parameter.smallest && value <= parameter.largest) continue;  // no largest
      Coupling coupling;
      coupling.*parameter.member = value;
      EXPECT_THROW(LineResponse{coupling}, kernel::Error) << parameter.name << " " << value;
    }
  }
}

TEST(CouplingTest, RefusesAReceiverThatDoesNotSeeTheQuietLine) {
  Coupling coupling;
  coupling.bit_v = 0.3;
  coupling.threshold_v = 0.2;
  coupling.hysteresis_mv = 198;
  EXPECT_NO_THROW(LineResponse{coupling});
  coupling.hysteresis_mv = 200;
  EXPECT_THROW(LineResponse{coupling}, kernel::Error);
}

TEST(CouplingTest, TheTableHoldsTheDefaultsWithinItsRanges) {
  const Coupling coupling;
  for (const CouplingParameter& parameter : coupling_parameters()) {
    EXPECT_GE(coupling.*parameter.member, parameter.smallest) << parameter.name;
    EXPECT_LE(coupling.*parameter.member, parameter.largest) << parameter.name;
    EXPECT_FALSE(parameter.meaning.empty());
    // The unit is the last word of the name.
    std::string unit(parameter.unit);
    for (char& c : unit) c = static_cast<char>(std::tolower(c));
    EXPECT_TRUE(parameter.name.ends_with(unit)) << parameter.name;
  }
}

// Without resonance and common-mode limit one polarity can only pull one level over the threshold, and both
// polarities do the same to opposite levels.
TEST(CouplingTest, PolaritiesAreMirrorImages) {
  Coupling coupling;
  const LineResponse response(coupling);
  for (const double volts : {500.0, 1000.0, 4000.0}) {
    const WrongOutput positive = response.wrong_output(volts, Polarity::positive);
    const WrongOutput negative = response.wrong_output(volts, Polarity::negative);
    EXPECT_EQ(positive.of_level[0], negative.of_level[1]);
    EXPECT_EQ(positive.of_level[1], negative.of_level[0]);
  }
  coupling.ringing_part = 0;
  const LineResponse smooth(coupling);
  // The pulse after the clamp's capacitance has an undershoot, which stays below the threshold here.
  EXPECT_TRUE(smooth.wrong_output(800, Polarity::positive).of_level[1].empty());
  EXPECT_FALSE(smooth.wrong_output(800, Polarity::positive).of_level[0].empty());
}

TEST(CouplingTest, BeyondTheCommonModeLimitTheOutputIsForced) {
  Coupling coupling;
  coupling.imbalance_db = 45;
  coupling.common_mode_limit_v = 12;
  for (const bool forced : {false, true}) {
    coupling.forced_level = forced;
    const WrongOutput wrong = LineResponse(coupling).wrong_output(100, Polarity::positive);
    EXPECT_TRUE(wrong.of_level.at(forced ? 1 : 0).empty());
    EXPECT_FALSE(wrong.of_level.at(forced ? 0 : 1).empty());
  }
  // The recovery prolongs it.
  const kernel::Duration usual = LineResponse(coupling).wrong_output(100, Polarity::positive).duration(false);
  coupling.recovery_ns = 350;
  const kernel::Duration slow = LineResponse(coupling).wrong_output(100, Polarity::positive).duration(false);
  EXPECT_EQ(slow - usual, 250 * kernel::kNanosecond);
}

TEST(CouplingTest, NothingIsWrongJustBelowTheThreshold) {
  Coupling coupling;
  coupling.hysteresis_mv = 0;
  for (const double limit : {12.0, std::numeric_limits<double>::infinity()}) {
    coupling.common_mode_limit_v = limit;
    const LineResponse response(coupling);
    const double threshold = response.threshold_volts();
    EXPECT_TRUE(response.wrong_output(threshold * 0.9999, Polarity::positive).empty());
    EXPECT_FALSE(response.wrong_output(threshold * 1.0001, Polarity::positive).empty());
  }
}

// Each doubling of the voltage lasts tau_r * ln 2 = 88 ns longer, in steps of half a ring period of 100 ns.
TEST(CouplingTest, DisturbedTimeGrowsByTheDecayOfTheRing) {
  Coupling coupling;
  coupling.common_mode_limit_v = 12;
  const LineResponse response(coupling);
  constexpr double kDoublings = 6;
  const double expected_ns = 4 / (3.141592653589793 * 10e6) * std::log(2) * 1e9;
  expect_near(expected_ns, 88);
  double sum_ns = 0;
  int count = 0;
  for (double volts = 100; volts < 156; volts *= 1.01) {
    const auto duration = [&](double v) {
      return static_cast<double>(response.wrong_output(v, Polarity::positive).hull().to.count()) / 1000;
    };
    const double growth_ns = duration(volts * 64) - duration(volts);
    EXPECT_NEAR(growth_ns, kDoublings * expected_ns, 50) << volts;
    sum_ns += growth_ns;
    ++count;
  }
  // The steps average out.
  expect_near(sum_ns / count / kDoublings, expected_ns, 0.03);
}

}  // namespace
}  // namespace fieldproof::emc
