#include "protocols/fieldbus_dll/control_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "harness/kernel/error.hpp"
#include "harness/kernel/sanitized.hpp"

namespace fieldproof::fieldbus_dll {
namespace {

constexpr std::int64_t kMs = 1'000'000'000;  // ps

ControlLoopSetting setting_of(DataWay way, double messages_per_s) {
  ControlLoopSetting setting;
  setting.way = way;
  setting.messages_per_s = messages_per_s;
  setting.periods = 240;
  return setting;
}

void expect_nothing_lost(const HopFigures& hop, std::uint64_t sent) {
  EXPECT_EQ(hop, (HopFigures{.sent = sent, .used = sent, .lost = 0, .missing = 0, .vacant = 0}));
}

// Independent of Pid and Process: positional PID and the lags by steps of Runge and Kutta, each block where
// its place in the period is. Values travel as single precision.
std::vector<double> by_difference_equations(unsigned periods) {
  constexpr double kT = 0.25;
  double x = 0, y = 0, valve = 0, sum = 0, order = 0, y_1 = 0, base = 0;
  bool has_begun = false;
  const auto advance = [&](double seconds) {
    const int steps = 200;
    const double h = seconds / steps;
    const auto dx = [&](double a) { return (valve - a) / 1.0; };
    const auto dy = [&](double a, double b) { return (a - b) / 0.4; };
    for (int n = 0; n < steps; ++n) {
      const double k1 = dx(x), l1 = dy(x, y);
      const double k2 = dx(x + h / 2 * k1), l2 = dy(x + h / 2 * k1, y + h / 2 * l1);
      const double k3 = dx(x + h / 2 * k2), l3 = dy(x + h / 2 * k2, y + h / 2 * l2);
      const double k4 = dx(x + h * k3), l4 = dy(x + h * k3, y + h * l3);
      x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      y += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
    }
  };
  std::vector<double> process;
  for (unsigned n = 0; n < periods; ++n) {
    const double setpoint = n / 60 % 2 == 0 ? 60 : 40;
    const double sample = static_cast<float>(y);
    process.push_back(y);
    advance(0.95 * kT);
    const double error = setpoint - sample;
    if (!has_begun) y_1 = sample;
    has_begun = true;
    // u = K (e + sum e T / Ti - Td dy / T), moved as a whole when it was at a limit.
    sum += error * kT / 1.4;
    const double wanted = base + 1.5 * (error + sum - 0.1 * (sample - y_1) / kT);
    order = std::clamp(wanted, 0.0, 100.0);
    base += order - wanted;
    y_1 = sample;
    valve = static_cast<float>(order);
    advance(0.05 * kT);
  }
  return process;
}

TEST(ControlLoopTest, WithoutABusIsWhatTheDifferenceEquationsSay) {
  const ControlLoop loop = run_loop_without_bus(setting_of(DataWay::published, 0));
  const std::vector<double> wanted = by_difference_equations(240);
  for (std::size_t n = 0; n < wanted.size(); ++n)
    ASSERT_NEAR(loop.course[10 * n].process, wanted[n], 1e-3) << n;
}

TEST(ControlLoopTest, SettlesAtItsSetpoint) {
  const ControlLoop loop = run_loop_without_bus(setting_of(DataWay::published, 0));
  EXPECT_NEAR(loop.course[599].process, 60, 0.01);
  EXPECT_NEAR(loop.course[1199].process, 40, 0.01);
}

// The schedule has room for what blocks do, so the bus costs nothing, whatever else goes over it.
TEST(ControlLoopTest, PublishedOverAQuietBusIsTheLoopWithoutABus) {
  for (const double messages : kernel::kIsSanitized ? std::vector{2.0} : std::vector{0.0, 2.0, 20.0}) {
    const ControlLoopSetting setting = setting_of(DataWay::published, messages);
    const ControlLoop loop = run_control_loop(setting);
    EXPECT_EQ(loop.course, run_loop_without_bus(setting).course) << messages;
    expect_nothing_lost(loop.to_controller, 240);
    expect_nothing_lost(loop.to_valve, 240);
    EXPECT_EQ(loop.loop_delay.min(), 237'500 * kMs / 1'000);
    EXPECT_EQ(loop.loop_delay.max(), loop.loop_delay.min());
  }
}

TEST(ControlLoopTest, ByTokenAmongMessagesLosesSamplesAndFindsNothing) {
  const ControlLoopSetting setting = setting_of(DataWay::by_token, 2);
  const ControlLoop loop = run_control_loop(setting);
  EXPECT_GT(loop.to_controller.lost, 0U);
  EXPECT_GT(loop.to_controller.vacant, 0U);
  EXPECT_GT(loop.loop_delay.max(), loop.loop_delay.min());
  EXPECT_GT(loop.absolute_error, run_loop_without_bus(setting).absolute_error);
}

// Each sample is used, lost or missing; each execution finds something new or nothing.
TEST(ControlLoopTest, KeepsItsBooks) {
  for (std::uint64_t seed = 1; seed <= (kernel::kIsSanitized ? 1U : 4U); ++seed) {
    for (const DataWay way : {DataWay::published, DataWay::by_token}) {
      ControlLoopSetting setting = setting_of(way, 1.5);
      setting.seed = seed;
      setting.disturb = losing_frames(0.05, kernel::Random(seed));
      const ControlLoop loop = run_control_loop(setting);
      for (const HopFigures& hop : {loop.to_controller, loop.to_valve}) {
        EXPECT_EQ(hop.sent, hop.used + hop.lost + hop.missing);
        EXPECT_LE(hop.used + hop.vacant, setting.periods);
        EXPECT_GT(hop.missing, 0U);
      }
      EXPECT_EQ(loop.to_controller.used, loop.delay_to_controller.count());
      EXPECT_EQ(loop.to_valve.used, loop.loop_delay.count());
    }
  }
}

// A sample is missing when its CD or its DT3 is lost.
TEST(ControlLoopTest, WhatIsMissingIsWhatTheLineLoses) {
  ControlLoopSetting setting = setting_of(DataWay::published, 0);
  const unsigned periods = kernel::kIsSanitized ? 240 : 1'200;
  setting.periods = periods;
  setting.disturb = losing_frames(0.05, kernel::Random(7));
  const ControlLoop loop = run_control_loop(setting);
  const double share = static_cast<double>(loop.to_controller.missing) / periods;
  EXPECT_NEAR(share, 1 - 0.95 * 0.95, 5 * std::sqrt(0.0975 * 0.9025 / periods));
  EXPECT_EQ(loop.to_controller.vacant, loop.to_controller.missing);
}

ControlLoopSetting operated(double messages_per_s) {
  ControlLoopSetting setting = setting_of(DataWay::published, messages_per_s);
  setting.has_operator = true;
  setting.target_rotation = 200 * kernel::kMillisecond;
  return setting;
}

// How long urgent data waits at most: for one token, and for its DT1, 21 octets with what is around it, and
// the PT and silences in front of it.
kernel::Duration one_token(const ControlLoop& loop) {
  return loop.longest_without_token + 50 * 256 * kernel::kMicrosecond;
}

void expect_books(const RelationshipFigures& figures) {
  EXPECT_EQ(figures.sent, figures.arrived + figures.missing);
  EXPECT_EQ(figures.arrived, figures.delay.count());
}

TEST(ControlLoopTest, AnOperatorIsAnsweredAndTold) {
  const ControlLoop loop = run_control_loop(operated(0));
  for (const RelationshipFigures* const figures : {&loop.requests, &loop.alarms, &loop.trends}) {
    expect_books(*figures);
    EXPECT_LE(figures->missing, 1U) << "on its way at the end";
  }
  // In each of 60 s a read, or a setpoint in its place.
  EXPECT_EQ(loop.requests.sent, 60U);
  EXPECT_EQ(loop.trends.sent, 60U);
  EXPECT_EQ(loop.alarms.sent, 4U);
  EXPECT_LE(loop.alarms.delay.max(), one_token(loop).count());
  // There and back.
  EXPECT_LE(loop.requests.delay.max(), 2 * one_token(loop).count());
  EXPECT_NEAR(loop.course[599].process, 60, 0.01);
  EXPECT_NEAR(loop.course[1199].process, 40, 0.01);
}

// The controller knows each setpoint later than it is wanted.
TEST(ControlLoopTest, ASetpointThatIsWrittenComesLate) {
  const ControlLoop loop = run_control_loop(operated(0));
  EXPECT_GT(loop.absolute_error, run_loop_without_bus(setting_of(DataWay::published, 0)).absolute_error);
  EXPECT_EQ(loop.to_controller.missing, 0U);
}

TEST(ControlLoopTest, AmongMessagesAlarmsGoWithTheNextTokenAndTrendsLater) {
  const ControlLoop loop = run_control_loop(operated(1.5));
  EXPECT_EQ(loop.alarms.missing, 0U);
  EXPECT_LE(loop.alarms.delay.max(), one_token(loop).count());
  EXPECT_GT(loop.trends.delay.max(), one_token(loop).count());
}

// A rotation without any data takes longer than V(TTRT): nothing but urgent data ever goes, and the
// controller never learns a setpoint.
TEST(ControlLoopTest, ATargetBelowTheRotationLetsNoRequestThrough) {
  ControlLoopSetting setting = operated(0);
  setting.target_rotation = 100 * kernel::kMillisecond;
  const ControlLoop loop = run_control_loop(setting);
  EXPECT_GT(loop.requests.sent, 0U);
  EXPECT_EQ(loop.requests.arrived, 0U);
  EXPECT_EQ(loop.trends.arrived, 0U);
  EXPECT_EQ(loop.course.back().process, 0);
}

// What is lost is told; a setpoint is written until it is confirmed.
TEST(ControlLoopTest, AnOperatorOnALossyLineGetsThere) {
  ControlLoopSetting setting = operated(0);
  setting.disturb = losing_frames(0.1, kernel::Random(3));
  const ControlLoop loop = run_control_loop(setting);
  for (const RelationshipFigures* const figures : {&loop.requests, &loop.alarms, &loop.trends})
    expect_books(*figures);
  EXPECT_GT(loop.requests.missing, 1U);
  EXPECT_GT(loop.trends.missing, 1U);
  EXPECT_NEAR(loop.course[599].process, 60, 1);
  EXPECT_NEAR(loop.course[1199].process, 40, 1);
}

TEST(ControlLoopTest, WithoutAnOperatorNothingIsAsked) {
  const ControlLoop loop = run_control_loop(setting_of(DataWay::published, 0));
  EXPECT_EQ(loop.requests.sent + loop.alarms.sent + loop.trends.sent, 0U);
}

TEST(ControlLoopTest, IsTheSameFromTheSameSeed) {
  ControlLoopSetting setting = setting_of(DataWay::by_token, 2);
  setting.periods = kernel::kIsSanitized ? 40 : 240;
  const ControlLoop first = run_control_loop(setting);
  EXPECT_EQ(first.course, run_control_loop(setting).course);
  setting.seed = 2;
  EXPECT_NE(first.course, run_control_loop(setting).course);
}

TEST(ControlLoopTest, RefusesWhatCannotBeRun) {
  const auto refused = [](auto change) {
    ControlLoopSetting setting;
    change(setting);
    EXPECT_THROW(run_control_loop(setting), kernel::Error);
  };
  refused([](ControlLoopSetting& setting) { setting.sampling_period = 79 * kernel::kMillisecond; });
  refused([](ControlLoopSetting& setting) { setting.sampling_period += kernel::Duration{1}; });
  refused([](ControlLoopSetting& setting) { setting.bit_rate = 9'600; });
  refused([](ControlLoopSetting& setting) { setting.periods = 0; });
  refused([](ControlLoopSetting& setting) { setting.messages_per_s = -1; });
  refused([](ControlLoopSetting& setting) { setting.messages_per_s = std::nan(""); });
  refused([](ControlLoopSetting& setting) { setting.disturb = losing_frames(1, kernel::Random(1)); });
}

}  // namespace
}  // namespace fieldproof::fieldbus_dll
