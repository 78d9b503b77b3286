#include "harness/segment/monitor.hpp"

#include <gtest/gtest.h>

#include <string>

#include "harness/kernel/check.hpp"

namespace fieldproof::segment {
namespace {

using kernel::Duration;
using kernel::kMicrosecond;
using kernel::kPicosecond;
using kernel::kStart;

class Monitor : public testing::Test {
 protected:
  // A transmission of so many microseconds.
  static line::Waveform wave(Duration start, std::size_t levels) {
    line::Waveform wave;
    wave.start = kStart + start;
    wave.rate = 1'000'000;
    wave.levels.append_fill(false, levels);
    return wave;
  }
  static std::string text(const LineMonitor& monitor) {
    std::string result;
    for (const Violation& violation : monitor.violations()) {
      result += std::string(text_of(violation.kind)) + " " + kernel::describe(violation.measured) + "; ";
    }
    return result;
  }
  LineMonitor made(const MonitorRules& rules) {
    return LineMonitor(rules, trace_, trace_.add_channel("line"));
  }

  trace::Trace trace_;
};

TEST_F(Monitor, SeesOverlapsWithoutAnyRule) {
  LineMonitor monitor = made({});
  monitor.on_wave(wave(Duration{}, 10));
  monitor.on_wave(wave(10 * kMicrosecond, 10));
  EXPECT_EQ(text(monitor), "");
  monitor.on_wave(wave(20 * kMicrosecond - kPicosecond, 1));
  EXPECT_EQ(text(monitor), "monitor: overlap 1 ps; ");
  monitor.on_wave(wave(15 * kMicrosecond, 1));
  EXPECT_EQ(monitor.count(), 2U);
}

TEST_F(Monitor, TakesAnOverlapWithinRoundingForNone) {
  MonitorRules rules;
  rules.rounding = kernel::kNanosecond;
  LineMonitor monitor = made(rules);
  monitor.on_wave(wave(Duration{}, 10));
  monitor.on_wave(wave(10 * kMicrosecond - kernel::kNanosecond, 10));
  EXPECT_EQ(text(monitor), "");
  monitor.on_wave(wave(20 * kMicrosecond - 2 * kernel::kNanosecond - kPicosecond, 1));
  EXPECT_EQ(text(monitor), "monitor: overlap 1.001 ns; ");
}

TEST_F(Monitor, TakesWhatIsKnownLaterAndLiesInTheSilenceBefore) {
  LineMonitor monitor = made({});
  monitor.on_wave(wave(Duration{}, 10));
  monitor.on_wave(wave(40 * kMicrosecond, 10));
  monitor.on_wave(wave(20 * kMicrosecond, 20));
  EXPECT_EQ(text(monitor), "");
  monitor.on_wave(wave(39 * kMicrosecond, 1));
  EXPECT_EQ(monitor.count(), 1U) << "it overlaps what lies there";
  monitor.on_wave(wave(10 * kMicrosecond, 10));
  EXPECT_EQ(monitor.count(), 2U) << "what lies further back is not known any more";
}

TEST_F(Monitor, CountsWhatIsKnownLaterToo) {
  MonitorRules rules;
  rules.most_transmissions = 3;
  rules.window = 100 * kMicrosecond;
  LineMonitor monitor = made(rules);
  for (const int at : {10, 30, 20}) monitor.on_wave(wave(at * kMicrosecond, 5));
  EXPECT_EQ(monitor.count(), 0U);
  monitor.on_wave(wave(50 * kMicrosecond, 5));
  EXPECT_EQ(monitor.violations().at(0).kind, ViolationKind::too_many);
}

TEST_F(Monitor, SeesSilencesOnBothSidesOfTheLimit) {
  MonitorRules rules;
  rules.longest_silence = 25 * kMicrosecond;
  LineMonitor monitor = made(rules);
  monitor.finish(kStart + 100 * kMicrosecond);
  EXPECT_EQ(monitor.count(), 0U) << "nothing is asked before the first transmission";
  monitor.on_wave(wave(100 * kMicrosecond, 5));
  monitor.on_wave(wave(130 * kMicrosecond, 5));
  EXPECT_EQ(text(monitor), "");
  monitor.on_wave(wave(160 * kMicrosecond + kPicosecond, 5));
  EXPECT_EQ(text(monitor), "monitor: silence too long 25.000001 us; ");
  monitor.finish(kStart + 190 * kMicrosecond + kPicosecond);
  EXPECT_EQ(monitor.count(), 1U);
  monitor.finish(kStart + 190 * kMicrosecond + 2 * kPicosecond);
  EXPECT_EQ(monitor.count(), 2U);
}

TEST_F(Monitor, SeesGapsThatAreTooShortButNotTransmissionsWithoutAGap) {
  MonitorRules rules;
  rules.shortest_gap = 3 * kMicrosecond;
  LineMonitor monitor = made(rules);
  monitor.on_wave(wave(Duration{}, 5));
  monitor.on_wave(wave(5 * kMicrosecond, 5));
  monitor.on_wave(wave(13 * kMicrosecond, 5));
  EXPECT_EQ(text(monitor), "");
  monitor.on_wave(wave(21 * kMicrosecond - kPicosecond, 5));
  EXPECT_EQ(text(monitor), "monitor: gap too short 2.999999 us; ");
}

TEST_F(Monitor, TellsADriveThatIsTooLongOnce) {
  MonitorRules rules;
  rules.longest_drive = 20 * kMicrosecond;
  LineMonitor monitor = made(rules);
  monitor.on_wave(wave(Duration{}, 10));
  monitor.on_wave(wave(10 * kMicrosecond, 10));
  EXPECT_EQ(text(monitor), "");
  monitor.on_wave(wave(20 * kMicrosecond, 1));
  monitor.on_wave(wave(21 * kMicrosecond, 1));
  EXPECT_EQ(text(monitor), "monitor: drives too long 21.000 us; ");
  monitor.on_wave(wave(23 * kMicrosecond, 21));
  EXPECT_EQ(monitor.count(), 2U) << "a pause begins a new run";
}

TEST_F(Monitor, CountsTransmissionsWithinAWindow) {
  MonitorRules rules;
  rules.most_transmissions = 3;
  rules.window = 100 * kMicrosecond;
  LineMonitor monitor = made(rules);
  for (const int start : {0, 10, 20, 100}) monitor.on_wave(wave(start * kMicrosecond, 1));
  EXPECT_EQ(text(monitor), "") << "the fourth begins when the window is over";
  monitor.on_wave(wave(109 * kMicrosecond, 1));
  EXPECT_EQ(text(monitor), "monitor: too many transmissions 99.000 us; ");
}

TEST_F(Monitor, KeepsABoundedListAndCountsAll) {
  LineMonitor monitor = made({});
  for (int n = 0; n < 200; ++n) monitor.on_wave(wave(Duration{}, 10));
  EXPECT_EQ(monitor.count(), 199U);
  EXPECT_EQ(monitor.violations().size(), LineMonitor::kKept);
  EXPECT_EQ(trace_.record_count(), 199U) << "each is an observation";
}

TEST_F(Monitor, NeedsLimitAndWindowTogether) {
  MonitorRules rules;
  rules.most_transmissions = 3;
  EXPECT_THROW(LineMonitor(rules, trace_, trace_.add_channel("line")), kernel::BrokenInvariant);
}

}  // namespace
}  // namespace fieldproof::segment
