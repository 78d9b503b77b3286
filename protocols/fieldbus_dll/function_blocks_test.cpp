#include "protocols/fieldbus_dll/function_blocks.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "harness/kernel/error.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

TEST(SignalTest, IsStatusThenSinglePrecisionThenTheNumberOfTheSample) {
  // 1.5 is 3FC00000 in IEEE 754.
  EXPECT_EQ(octets_of({1.5F, SignalStatus::good, 0x01020304}),
            (Octets{0x80, 0x3F, 0xC0, 0x00, 0x00, 0x01, 0x02, 0x03, 0x04}));
}

RC_GTEST_PROP(SignalTest, ComesBackAsItWasSent, (int value, bool is_good, std::uint32_t sample)) {
  const Signal sent{static_cast<float>(value) / 7, is_good ? SignalStatus::good : SignalStatus::bad, sample};
  RC_ASSERT(signal_of(octets_of(sent)) == sent);
}

TEST(SignalTest, WhatIsNoSignalIsNone) {
  EXPECT_FALSE(signal_of(Octets{}));
  EXPECT_FALSE(signal_of(Octets(8, 0)));
  EXPECT_FALSE(signal_of(Octets{0x41, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(signal_of(Octets{0x80, 0x7F, 0xC0, 0, 0, 0, 0, 0, 0}));  // no number
}

TEST(AnalogInputTest, OutOfItsRangeIsTheNearestEndAndBad) {
  AnalogInput input(0, 100);
  EXPECT_EQ(input.execute(50), (Signal{50, SignalStatus::good, 1}));
  EXPECT_EQ(input.execute(101), (Signal{100, SignalStatus::bad, 2}));
  EXPECT_EQ(input.execute(-1), (Signal{0, SignalStatus::bad, 3}));
  EXPECT_EQ(input.execute(std::numeric_limits<double>::quiet_NaN()), (Signal{0, SignalStatus::bad, 4}));
}

// For a constant error e the output after n executions is gain * e * (1 + n * period / reset).
TEST(PidTest, OfAConstantErrorIsItsProportionAndItsIntegral) {
  Pid pid({.gain = 0.5, .reset_s = 4, .rate_s = 3, .period_s = 0.25, .low = -1000, .high = 1000});
  double output = 0;
  for (int n = 1; n <= 40; ++n) output = pid.execute({10, SignalStatus::good, 1}, 30).value;
  EXPECT_NEAR(output, -1000 + 0.5 * 20 * (1 + 40 * 0.25 / 4), 1e-4);
}

// For a measured ramp the rate takes gain * rate * slope, once it has begun.
TEST(PidTest, OfARampIsItsRate) {
  const double slope = -2;  // upwards from the low limit
  Pid with({.gain = 1, .reset_s = 0, .rate_s = 3, .period_s = 0.5, .low = -1000, .high = 1000});
  Pid without({.gain = 1, .reset_s = 0, .rate_s = 0, .period_s = 0.5, .low = -1000, .high = 1000});
  float difference = 0;
  for (int n = 0; n < 10; ++n) {
    const Signal measured{static_cast<float>(slope * 0.5 * n), SignalStatus::good, 1};
    difference = with.execute(measured, 20).value - without.execute(measured, 20).value;
  }
  EXPECT_NEAR(difference, -3 * slope, 1e-4);
}

TEST(PidTest, DoesNotWindUpAtItsLimit) {
  Pid pid({.gain = 1, .reset_s = 1, .rate_s = 0, .period_s = 1, .low = 0, .high = 100});
  for (int n = 0; n < 1'000; ++n) pid.execute({0, SignalStatus::good, 1}, 50);
  // Back within its limits with the first error of the other sign.
  EXPECT_LT(pid.execute({60, SignalStatus::good, 1}, 50).value, 100);
}

TEST(PidTest, HoldsItsOutputWhileItsInputIsBad) {
  Pid pid({.gain = 1, .reset_s = 1, .rate_s = 0, .period_s = 1});
  const Signal good = pid.execute({10, SignalStatus::good, 1}, 20);
  const Signal bad = pid.execute({100, SignalStatus::bad, 2}, 20);
  EXPECT_EQ(bad.value, good.value);
  EXPECT_EQ(bad.status, SignalStatus::bad);
}

TEST(PidTest, RefusesWhatIsNoController) {
  EXPECT_THROW(Pid({.period_s = 0}), kernel::Error);
  EXPECT_THROW(Pid({.reset_s = -1}), kernel::Error);
  EXPECT_THROW(Pid({.low = 1, .high = 1}), kernel::Error);
}

TEST(AnalogOutputTest, StaysWhereItIsWhenWhatIsWantedIsBad) {
  AnalogOutput output;
  EXPECT_EQ(output.execute({30, SignalStatus::good, 1}), 30);
  EXPECT_EQ(output.execute({70, SignalStatus::bad, 2}), 30);
}

// Independent: the same equations by small steps of Euler, twice with half the step, extrapolated.
double by_small_steps(double seconds, double input, int steps) {
  double first = 0;
  double second = 0;
  for (int n = 0; n < steps; ++n) {
    const double more_first = (2 * input - first) / 1.5;
    const double more_second = (first - second) / 0.4;
    first += more_first * seconds / steps;
    second += more_second * seconds / steps;
  }
  return second;
}

TEST(ProcessTest, IsTwoLagsInARow) {
  for (const double seconds : {0.01, 0.3, 2.0, 9.0}) {
    Process process(2, 1.5, 0.4);
    process.advance(seconds, 10);
    const double extrapolated =
        2 * by_small_steps(seconds, 10, 200'000) - by_small_steps(seconds, 10, 100'000);
    EXPECT_NEAR(process.output(), extrapolated, 1e-7) << seconds;
  }
}

RC_GTEST_PROP(ProcessTest, IsTheSameInOneStepAndInMany, ()) {
  const double input = *rc::gen::inRange(-100, 100);
  const int parts = *rc::gen::inRange(1, 50);
  Process once(1, 1, 0.4);
  Process often(1, 1, 0.4);
  once.advance(2, input);
  for (int n = 0; n < parts; ++n) often.advance(2.0 / parts, input);
  RC_ASSERT(std::abs(once.output() - often.output()) < 1e-9);
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
