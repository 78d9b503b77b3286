#include "emc/pulse.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fieldproof::emc {
namespace {

// `part` of the figure, 1 % where nothing is said.
void expect_near(double measured, double figure, double part = 0.01) {
  EXPECT_NEAR(measured, figure, figure * part);
}

TEST(PulseTest, TheStandardFormulaHasTheFiguresOfItsCalculation) {
  const PulseFigures figures = measure(Pulse(PulseShape::standard_formula));
  expect_near(figures.peak, 1.0027, 0.0001);
  expect_near(figures.peak_ns, 10.76);
  expect_near(figures.rise_ns, 5.12);
  expect_near(figures.width_ns, 49.4);
  expect_near(figures.tail_ns, 134);
  expect_near(figures.area_ns, 64.4);
  expect_near(figures.square_area_ns, 37.4);
}

TEST(PulseTest, TheDoubleExponentialHasTheFiguresOfItsCalculation) {
  const PulseFigures figures = measure(Pulse(PulseShape::double_exponential));
  expect_near(figures.peak, 1.000);
  expect_near(figures.rise_ns, 5.00);
  expect_near(figures.width_ns, 50.0);
}

// 5 ns and 50 ns, both with 30 % of tolerance, into 50 ohm; peak within 10 %.
TEST(PulseTest, BothShapesAreWithinTheTolerancesOfTheStandard) {
  for (const PulseShape shape : {PulseShape::standard_formula, PulseShape::double_exponential}) {
    const PulseFigures figures = measure(Pulse(shape));
    expect_near(figures.rise_ns, 5, 0.3);
    expect_near(figures.width_ns, 50, 0.3);
    expect_near(figures.peak, 1, 0.1);
  }
}

// The energy that a setting of 4 kV gives into 50 ohm, where half of the voltage is left: 2.99 mJ.
TEST(PulseTest, EnergyIntoTheMatchedLoad) {
  const double square_seconds = measure(Pulse()).square_area_ns * 1e-9;
  expect_near(2000.0 * 2000.0 / 50 * square_seconds, 2.99e-3);
}

TEST(PulseTest, IsTheFormulaWrittenWithTheLibrary) {
  const double k = std::exp(-(3.5 / 51) * std::pow(1.8 * 51 / 3.5, 1 / 1.8));
  EXPECT_NEAR(k, 0.65612, 0.00001);
  const Pulse pulse;
  for (double ns = 0.1; ns < 500; ns *= 1.2) {
    const double x = std::pow(ns / 3.5, 1.8);
    EXPECT_NEAR(pulse.at(ns * 1e-9), 0.92 / k * x / (1 + x) * std::exp(-ns / 51), 1e-13) << ns;
  }
}

TEST(PulseTest, NothingBeforeItsBegin) {
  for (const PulseShape shape : {PulseShape::standard_formula, PulseShape::double_exponential}) {
    EXPECT_EQ(Pulse(shape).at(-1e-9), 0);
    EXPECT_EQ(Pulse(shape).at(0), 0);
    EXPECT_GT(Pulse(shape).at(1e-12), 0);
  }
}

}  // namespace
}  // namespace fieldproof::emc
